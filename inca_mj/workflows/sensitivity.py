"""The information of a log on parameters of the robot, before a fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification import Log, noise_floor
from identification.estimation.experiment import Experiment, information
from identification.estimation.information import Information
from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import TIMESTEP, UNKNOWN
from inca_mj.twin.logs import ANGLES, POSE
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.comparison import timestep_for

NOISE = 6.7e-4  # std of an encoder of 4000 counts a turn and its 0.5 mrad of noise [rad]
DURATION = 5.0  # of the PRBS that is used without a log [s]


def planned_experiment(
    log: Log | None = None,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    noise: float | None = None,
    duration: float = DURATION,
    timestep: float = TIMESTEP,
) -> Experiment:
    """Returns the experiment of the twin under the currents of a log, or under the thesis' PRBS.

    The noise [rad] is what is seen in the log, or that of an encoder, where none is given.

    Raises:
        InputError: the noise, the duration or the step is not admitted, or the start has no
            pretension.
    """
    if log is None:
        currents, sampling_time, hold = make_input("prbs", duration), 0.01, "zoh"
        sigma = NOISE
    else:
        currents, sampling_time, hold = log.inputs, log.sampling_time, log.hold
        sigma = float(np.sqrt(np.mean(noise_floor(log.outputs) ** 2)))
    step = timestep_for(sampling_time, timestep)
    robot = build_twin(parameters, geometry, timestep=step, visual=False)
    return Experiment(
        plant=robot, inputs=currents, sampling_time=sampling_time, outputs=ANGLES,
        sigma=sigma if noise is None else noise, hold=hold,
    )  # fmt: skip


def sensitivity(
    log: Log | None = None,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    free: Sequence[str] = UNKNOWN,
    noise: float | None = None,
    duration: float = DURATION,
    timestep: float = TIMESTEP,
) -> Information:
    """Returns how well angles determine parameters, and which only together; the pose is unknown.

    Args:
        log: the log whose currents are used; the thesis' PRBS when None.
        parameters: the twin's values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        free: parameters to look at.
        noise: std of the noise on each angle [rad]; when None, what is seen in the log, or that of
            an encoder.
        duration: of the PRBS [s]; a log has its own.
        timestep: largest step of the integrator [s].

    Raises:
        InputError: a name is unknown or has no effect, or for the reasons of `planned_experiment`.
        DivergenceError: the twin cannot be simulated under these currents.
    """
    trial = planned_experiment(
        log, parameters, geometry, noise=noise, duration=duration, timestep=timestep
    )
    return robot_information(trial, free)


def robot_information(
    trial: Experiment, names: Sequence[str], resolved: bool = True
) -> Information:
    """Returns what an experiment would say of some parameters; the start pose is unknown too.

    Twice as many simulations estimate the errors of the sensitivities (`resolved`).

    Raises:
        InputError: a name is unknown or named twice, or has no effect on any output.
        DivergenceError: a simulation left the finite numbers.
    """
    return information(trial, names, [n for n in POSE if n not in names], resolved)
