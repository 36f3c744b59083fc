"""Identification of a disturbed robot: over windows with free states, or by innovations."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from identification import Log
from identification.errors import InputError
from identification.estimation.estimation import estimate
from identification.estimation.fit import assess
from identification.kalman.estimate import estimate_innovations
from identification.model.parameter import ParameterSet
from identification.windows.window_estimate import estimate_windows
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import POSE, TIMESTEP, UNKNOWN
from inca_mj.workflows.identification import MECHANICS, Identification, nominal_plant

FIRST = 4  # windows of the free run that gives the starting values of the search


def identify_windows(
    log: Log,
    length: float,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    free: Sequence[str] = (),
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
) -> Identification:
    """Identify the robot over windows of the estimation part, then confirm it in a free run.

    A free run over the first few windows gives the starting values of the search. The initial state
    of each window is free: pose, rates and the eight no-load lengths, which no angle measures, are
    fitted for each window (see `identification.windows.windows`). The start pose is a free
    parameter too, because the drum springs depend on the pretension at the start. At the end a free
    run fits this pose alone, and shows how well the parameters of the windows predict the whole
    log.

    Args:
        log: what was measured; its split `estimation`, or its first half, is fitted.
        length: of a window [s].
        parameters: nominal values, where the search begins; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        free: parameters to estimate; when empty, those of the drives, the cables and the platform's
            mass.
        progress: is told one line per accepted step.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: the windows do not fit the log, or for the reasons of `identify`.
        DivergenceError: the nominal values, or the free run, cannot be simulated.
    """
    if not length > 0:
        raise InputError(f"windows of {length:g} s hold nothing; give a length above 0")
    if free and not set(free) - set(POSE):
        raise InputError(
            f"windows cannot find {', '.join(free)} alone: each has a start of its own; name a"
            f" parameter of the robot too, such as {', '.join(UNKNOWN)}"
        )
    plant = nominal_plant(log, parameters, geometry, timestep, trust)
    fitted = log.part("estimation")
    names = tuple(dict.fromkeys((*(free or MECHANICS), *POSE)))
    time, end = fitted.time, float(fitted.time[0]) + FIRST * length
    early = fitted.between(float(time[0]), end) if end < time[-1] else fitted
    near = estimate(plant, early, names, progress=progress)
    if near.status == "stopped":
        return Identification(log=log, fits=(assess(near, log),))
    found = estimate_windows(plant, fitted, names, length, near.values, progress=progress)
    fit = assess(estimate(plant, fitted, POSE, found.values, progress=progress), log)
    return Identification(log=log, fits=(fit,), windows=found)


def identify_innovations(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    free: Sequence[str] = (),
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
) -> Identification:
    """Identify the robot by its innovations, where the true currents differ from the logged ones.

    Args:
        log: what was measured; its split `estimation`, or its first half, is fitted.
        parameters: nominal values, where the search begins; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        free: parameters to estimate; all of them and the pose when empty.
        progress: is told one line per accepted step.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: for the reasons of `identify`.
        DivergenceError: the nominal values cannot be simulated.
    """
    plant = nominal_plant(log, parameters, geometry, timestep, trust)
    names = tuple(free) or (*MECHANICS, *POSE)
    found = estimate_innovations(plant, log, names, progress=progress)
    return Identification(log=log, fits=(found.fit,), innovations=found)
