"""The thesis' two-step procedure on a log, with the step that predicts unseen data best kept.

Step 1 estimates every parameter and the start; step 2 only what no data sheet says, with the others
fixed at their nominal values and the search begun at step 1's (thesis section 3.3).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from identification import Log
from identification.estimation import Options, estimate
from identification.fit import Fit, assess
from identification.parameter import ParameterSet
from inca_mj.comparison import timestep_for
from inca_mj.geometry import INCA, Geometry
from inca_mj.mjcf import TIMESTEP
from inca_mj.twin import build_twin

MECHANICS = ("R", "R_s", "k_s", "lambda", "b", "J", "b_v", "b_c", "beta", "K_t", "m")
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
UNKNOWN = ("lambda", "b", "J", "b_v", "b_c", "beta")  # "arbitrary" or re-estimated in the thesis


@dataclass(frozen=True)
class Identification:
    """Fits of a log, and which of them to believe.

    Attributes:
        log: the whole log.
        fits: one, or the two steps.
        best: index of the fit with the smaller error on unseen data.
    """

    log: Log
    fits: tuple[Fit, ...]
    best: int

    @property
    def fit(self) -> Fit:
        """The fit to believe."""
        return self.fits[self.best]


def identify(
    log: Log,
    parameters: ParameterSet,
    geometry: Geometry = INCA,
    free: Sequence[str] = (),
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
) -> Identification:
    """Identify the robot from a log: fitted on its estimation part, confirmed on all of it.

    Args:
        log: what was measured; its split `estimation`, or its first half, is fitted.
        parameters: nominal values, where the search begins.
        geometry: anchors of the cables.
        free: parameters to estimate in one step; the two-step procedure when empty.
        options: how to search.
        progress: is told one line per accepted step.
        timestep: largest step of the integrator [s].

    Raises:
        InputError: a name is unknown or has no effect, or a start has no pretension.
        DivergenceError: the nominal values cannot be simulated.
    """
    plant = build_twin(parameters, geometry, timestep=timestep_for(log.sampling_time, timestep))
    fitted = log.part("estimation")

    def step(names: Sequence[str], start: dict[str, float]) -> Fit:
        return assess(estimate(plant, fitted, names, start, options, progress), log)

    if free:
        return Identification(log, (step(tuple(free), {}),), 0)
    all_of_it = step((*MECHANICS, *POSE), {})
    found = all_of_it.estimate.values
    unknown = (*UNKNOWN, *POSE)
    second = step(unknown, {name: found[name] for name in unknown})
    fits = (all_of_it, second)
    errors = [fit.rms if fit.validation_rms is None else fit.validation_rms for fit in fits]
    return Identification(log, fits, errors.index(min(errors)))
