"""The two steps that identify the robot from a log; the one that predicts best is believed.

**The usual steps** (`identify`). Step 1 estimates every parameter and the start. Step 2 estimates
only the parameters that no data sheet gives; the others are fixed at their nominal values, and the
search begins at the result of step 1 (thesis section 3.3). The step that predicts unseen data best
is kept.

**The thesis' steps** (`identify_as_thesis`). Step 1 (Table 3.7) frees all eleven parameters and
the start position, and begins at the table's initial values. Step 2 (Table 3.8) frees R, λ, J, b_v,
b_c, β, K_t and m. Of these R and K_t begin at their nominal values and the others where step 1
ended. R_s, k_s and the start position are fixed at their nominal values, b where step 1 ended. The
text of section 3.3.2 says that step 2 fixes what a data sheet or a measurement gives. The table is
what was done: it frees R, λ, K_t and m as well, and fixes b, which nothing gives.
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
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import POSE, TIMESTEP, UNKNOWN
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.comparison import timestep_for

MECHANICS = ("R", "R_s", "k_s", "lambda", "b", "J", "b_v", "b_c", "beta", "K_t", "m")
STEP_1 = {
    "R": 0.0175, "R_s": 0.006, "k_s": 16.0, "lambda": 25000.0, "b": 2.0, "J": 1e-4, "b_v": 2e-4,
    "b_c": 0.005, "beta": 0.8, "K_t": 0.0603, "m": 0.17246, "x": 0.0, "y": 0.0, "z": 1.47,
}  # fmt: skip
STEP_2 = ("R", "lambda", "J", "b_v", "b_c", "beta", "K_t", "m")
AT_NOMINAL = ("R", "K_t")  # free in step 2, and not begun where step 1 ended
HELD_FROM_STEP_1 = ("b",)


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
    best: int = 0
    starts: tuple[np.ndarray, ...] = field(default=())
    windows: WindowEstimate | None = None
    innovations: InnovationsFit | None = None

    @property
    def fit(self) -> Fit:
        """The fit to believe."""
        return self.fits[self.best]

    @property
    def stopped(self) -> bool:
        """Tells whether a search was stopped by the user; its best values are kept."""
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
    plant = nominal_plant(log, parameters, geometry, timestep, trust)
    fitted = log.part("estimation")
    tried: list[np.ndarray] = []

    def step(names: Sequence[str], start: dict[str, float]) -> Fit:
        if starts == 1:
            return assess(estimate(plant, fitted, names, start, options, progress), log)
        found = estimate_from(
            plant, fitted, names, starts, seed, start, options=options, progress=progress
        )
        tried.append(found.rms)
        return assess(found.best, log)

    fits = [step(tuple(free) or (*MECHANICS, *POSE), {})]
    if not free and fits[0].estimate.status != "stopped":
        found = fits[0].estimate.values
        unknown = (*UNKNOWN, *POSE)
        fits.append(step(unknown, {name: found[name] for name in unknown}))
    return Identification(log=log, fits=tuple(fits), best=_better(fits), starts=tuple(tried))


def identify_as_thesis(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
) -> Identification:
    """Identify the robot from a log by the two steps of the thesis' section 3.3.

    Args:
        log: what was measured; its split `estimation`, or its first half, is fitted.
        parameters: nominal values, where step 2 fixes R_s, k_s and the start, and begins R and
            K_t; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        options: how to search; `Options(horizons=(1.0,))` is the thesis' single free-run fit.
        progress: is told one line per accepted step.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: the log is not wired as the robot is, or a start has no pretension.
        DivergenceError: the first values cannot be simulated.
    """
    plant = nominal_plant(log, parameters, geometry, timestep, trust)
    fitted = log.part("estimation")
    first = assess(estimate(plant, fitted, tuple(STEP_1), STEP_1, options, progress), log)
    if first.estimate.status == "stopped":
        return Identification(log=log, fits=(first,))
    found, nominal = first.estimate.values, plant.parameters.values()
    held = plant.with_values({name: found[name] for name in HELD_FROM_STEP_1})
    start = {name: (nominal if name in AT_NOMINAL else found)[name] for name in STEP_2}
    second = assess(estimate(held, fitted, STEP_2, start, options, progress), log)
    return Identification(log=log, fits=(first, second), best=_better((first, second)))


def nominal_plant(
    log: Log,
    parameters: ParameterSet | None,
    geometry: Geometry,
    timestep: float,
    trust: Sequence[str],
) -> Twin:
    """Returns the nominal twin with a step that divides the log's; refuses a log of another."""
    step = timestep_for(log.sampling_time, timestep)
    plant = build_twin(parameters, geometry, timestep=step, visual=False)
    refuse_miswired(log, plant, trust)
    return plant


def _better(fits: Sequence[Fit]) -> int:
    """Returns the index of the fit with least error on unseen data, or on its own if none is."""
    errors = [fit.rms if fit.validation_rms is None else fit.validation_rms for fit in fits]
    return errors.index(min(errors))
