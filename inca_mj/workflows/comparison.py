"""The twin under the currents of a log: compared with what was measured, or linearised along it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np

from identification import Log, fit_percent, rms
from identification.model.parameter import ParameterSet
from identification.quantities import finite_or_none
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import TIMESTEP, parameter_set, refuse_step
from inca_mj.twin.logs import POSE, UNJUDGED, pose_of
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin, build_twin, rebuild

if TYPE_CHECKING:
    from inca_mj.linear.linearization import LinearModel


@dataclass(frozen=True)
class Comparison:
    """The measured angles, and those of the twin under the same currents.

    Attributes:
        log: the measured log.
        run: the twin's run under the log's currents, on the same samples.
        fit_percent: 100 (1 - ‖ŷ - y‖/‖y - ȳ‖) per angle (thesis 3.4), shape (8,) [%].
        rms: of the difference per angle, shape (8,) [rad].
    """

    log: Log
    run: Run
    fit_percent: np.ndarray
    rms: np.ndarray

    def to_json(self) -> dict[str, Any]:
        """Returns the numbers as plain values."""
        return {
            "fit_percent": [finite_or_none(f) for f in self.fit_percent],
            "rms": self.rms.tolist(),
            "samples": len(self.log),
            "seconds_simulated": self.log.duration,
        }


def compare(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
) -> Comparison:
    """Predict a log's angles from its currents alone, from its measured pose or the twin's start.

    Args:
        log: what was measured.
        parameters: the twin's values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: the start has no pretension, or the log is not wired as the robot is.
        DivergenceError: the simulation left the finite numbers.
    """
    parameters = start_of(log, parameters or parameter_set())
    step = timestep_for(log.sampling_time, timestep)
    robot = build_twin(parameters, geometry, timestep=step)
    return compare_twin(log, robot, timestep=timestep, trust=trust)


def compare_twin(
    log: Log, robot: Twin, *, timestep: float = TIMESTEP, trust: Sequence[str] = ()
) -> Comparison:
    """Predict a log's angles from its currents alone with a twin, from the twin's own start.

    Args:
        log: what was measured.
        robot: the twin, such as `load_twin` reads one.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: `timestep` is not between 1e-6 and 0.1 s, or the log is not wired as the robot.
        DivergenceError: the simulation left the finite numbers.
    """
    step = timestep_for(log.sampling_time, timestep)
    if step != robot.model.opt.timestep:
        robot = rebuild(robot, timestep=step)
    if {*UNJUDGED} - {*trust}:
        refuse_miswired(log, robot, trust)
    run = simulate(robot, log.inputs, log.sampling_time, hold_kind=log.hold)
    predicted = run.motor_angle
    return Comparison(
        log, run, fit_percent(log.outputs, predicted), rms(log.outputs - predicted)
    )  # fmt: skip


def linearize_log(
    log: Log,
    times: Sequence[float],
    parameters: ParameterSet,
    geometry: Geometry,
    timestep: float = TIMESTEP,
) -> tuple[LinearModel, ...]:
    """Linearises the twin along its free run under a log, from the log's pose where it has one.

    Raises:
        InputError: a time [s] is outside the log, a cable is slack there, or the start has no
            pretension.
        DivergenceError: the simulation left the finite numbers.
    """
    from inca_mj.linear.linearization import linearize_along

    step = timestep_for(log.sampling_time, timestep)
    robot = build_twin(start_of(log, parameters), geometry, timestep=step)
    return linearize_along(robot, log, times)


def start_of(log: Log, parameters: ParameterSet) -> ParameterSet:
    """Returns parameters with the start pose of the log, if it has one and they give no other."""
    pose = pose_of(log)
    nominal = parameter_set().values()
    if pose is None or any(parameters[name].value != nominal[name] for name in POSE):
        return parameters
    return parameters.with_values(dict(zip(POSE, pose[0].tolist(), strict=True)))


def timestep_for(sampling_time: float, largest: float = TIMESTEP) -> float:
    """Returns the largest step up to `largest` that divides the sampling time [s]."""
    refuse_step(largest)
    return sampling_time / ceil(sampling_time / largest - 1e-9)
