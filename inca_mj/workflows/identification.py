"""The thesis' two-step procedure on a log; the step that predicts unseen data best is kept.

Step 1 estimates every parameter and the start. Step 2 estimates only the parameters that no data
sheet gives; the others are fixed at their nominal values, and the search begins at the result of
step 1 (thesis section 3.3). `inca_mj.workflows.procedure` frees and fixes what the thesis' tables
say, which is not quite what its text says.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from identification import Log
from identification.errors import refuse_negative
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import Fit, assess
from identification.estimation.multistart import estimate_from
from identification.kalman.estimate import InnovationsFit
from identification.model.parameter import ParameterSet
from identification.windows.window_estimate import WindowEstimate
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import TIMESTEP, UNKNOWN
from inca_mj.twin.logs import POSE
from inca_mj.twin.twin import build_twin
from inca_mj.twin.wiring import refuse_miswired
from inca_mj.workflows.comparison import timestep_for

MECHANICS = ("R", "R_s", "k_s", "lambda", "b", "J", "b_v", "b_c", "beta", "K_t", "m")


@dataclass(frozen=True, kw_only=True)
class Identification:
    """Fits of a log, and which of them to believe.

    Attributes:
        log: the whole log.
        fits: one, or the two steps.
        best: index of the fit with the smaller error on unseen data.
        starts: for each fit the rms of its starts [rad], shape (n,), where several were allowed.
        windows: the estimate over windows, if there is one; the fit is then a free run with its
            values, and only the start pose is fitted.
        innovations: the estimate by innovations, if the fit is one.
    """

    log: Log
    fits: tuple[Fit, ...]
    best: int
    starts: tuple[np.ndarray, ...] = field(default=())
    windows: WindowEstimate | None = None
    innovations: InnovationsFit | None = None

    @property
    def fit(self) -> Fit:
        """The fit to believe."""
        return self.fits[self.best]

    @property
    def stopped(self) -> bool:
        """Whether a search was stopped by the user; its best values are kept."""
        return any(fit.estimate.status == "stopped" for fit in self.fits)

    @property
    def seconds(self) -> float:
        """Wall time of all searches."""
        searches = sum(fit.estimate.seconds for fit in self.fits)
        return searches + (self.windows.seconds if self.windows else 0.0)

    def fit_of(self, name: str) -> Fit:
        """Returns the fit to believe; if it holds the parameter fixed, one that estimates it."""
        has = (f for f in (self.fit, *self.fits) if name in f.estimate.space.names)
        return next(has, self.fit)

    @property
    def values(self) -> dict[str, float]:
        """The values that were found, by name: of the windows, if there are any, and of the fit."""
        return {**(self.windows.values if self.windows else {}), **self.fit.estimate.values}


def identify(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    free: Sequence[str] = (),
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
    starts: int = 1,
    seed: int = 0,
) -> Identification:
    """Identify the robot from a log: its estimation part is fitted, all of it is predicted.

    Args:
        log: what was measured; its split `estimation`, or its first half, is fitted.
        parameters: nominal values, where the search begins; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        free: parameters to estimate in one step; the two-step procedure when empty.
        options: how to search.
        progress: is told one line per accepted step.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.
        starts: how many starts each search may try, until one ends near the noise floor.
        seed: of the starts after the first.

    Raises:
        InputError: a name is unknown or has no effect, a start has no pretension, the seed is
            negative, or fewer than one start is asked for.
        DivergenceError: the nominal values cannot be simulated.
    """
    refuse_negative("seed", seed)
    timestep = timestep_for(log.sampling_time, timestep)
    plant = build_twin(parameters, geometry, timestep=timestep, visual=False)
    refuse_miswired(log, plant, trust)
    fitted = log.part("estimation")

    tried: list[np.ndarray] = []

    def outcome(fits: tuple[Fit, ...], best: int = 0) -> Identification:
        return Identification(log=log, fits=fits, best=best, starts=tuple(tried))

    def step(names: Sequence[str], start: dict[str, float]) -> Fit:
        if starts == 1:
            return assess(estimate(plant, fitted, names, start, options, progress), log)
        found = estimate_from(
            plant, fitted, names, starts, seed, start, options=options, progress=progress
        )
        tried.append(found.rms)
        return assess(found.best, log)

    if free:
        return outcome((step(tuple(free), {}),))
    all_of_it = step((*MECHANICS, *POSE), {})
    if all_of_it.estimate.status == "stopped":
        return outcome((all_of_it,))
    found = all_of_it.estimate.values
    unknown = (*UNKNOWN, *POSE)
    second = step(unknown, {name: found[name] for name in unknown})
    return outcome((all_of_it, second), better(all_of_it, second))


def better(*fits: Fit) -> int:
    """Returns the index of the fit with least error on unseen data, or on its own if none is."""
    errors = [fit.rms if fit.validation_rms is None else fit.validation_rms for fit in fits]
    return errors.index(min(errors))
