"""A twin under a controller: sampled, with what effects do outside its law."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import DivergenceError, InputError
from identification.model.rollout import substeps
from inca_mj.control.controller import Controller
from inca_mj.control.observer import Pose
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.logs import ANGLES
from inca_mj.twin.twin import Twin

NOTHING = np.empty((1, 0))


@dataclass(frozen=True)
class Controlled:
    """The record of a controller, N samples; `simulate(robot, currents)` is the run.

    Attributes:
        currents: shape (N, 8) [A]; sample k is held until k+1.
        seen: position of the platform as the controller saw it, shape (N, 3) [m].
    """

    currents: np.ndarray
    seen: np.ndarray


def run_loop(
    robot: Twin, controller: Controller, duration: float, *, knows_pose: bool = False,
    noise: float = 0.0, seed: int = 0,
) -> Controlled:  # fmt: skip
    """Drive a robot by a controller, from the robot's start on.

    Args:
        robot: the robot, with the effects that it truly has.
        controller: sees the motor angles, as the robot's encoders tell them.
        duration: of the run [s].
        knows_pose: whether the controller is told the true pose too.
        noise: std of the encoders' noise [rad].
        seed: of the noise.

    Raises:
        InputError: the model's step does not divide the controller's period, the noise is negative
            or no number, or the controller finds no pose.
        DivergenceError: the robot left the finite numbers.
    """
    if not (np.isfinite(noise) and noise >= 0):
        raise InputError(f"a noise of {noise:g} rad; give 0 or more")
    model, data = robot.model, mujoco.MjData(robot.model)
    begin, rng = robot.state(), np.random.default_rng(seed)
    data.qpos[:], data.qvel[:], data.act[:] = begin.qpos, begin.qvel, begin.act
    n, count = substeps(controller.period, model.opt.timestep), round(duration / controller.period)
    held, currents = np.empty((count * n, DRIVES)), np.empty((count + 1, DRIVES))
    seen = np.empty((count + 1, 3))
    readings = np.empty((4, 1, count + 1, DRIVES))  # φ as perfect encoders tell it, φ, ω, time
    for k in range(count + 1):
        readings[:2, 0, k], readings[2, 0, k] = data.qpos[7:], data.qvel[6:]
        readings[3, 0, k] = k * controller.period
        told = robot.outputs((), NOTHING, ANGLES, readings[:, :, : k + 1])[0, -1]
        told = told + noise * rng.standard_normal(DRIVES)
        pose = Pose(data.qpos[:3].copy(), data.qpos[3:7].copy()) if knows_pose else None
        currents[k] = controller.currents(told, pose)
        seen[k] = controller.pose.position
        if k == count:
            break
        held[k * n : (k + 1) * n] = currents[k]
        given = robot.inputs((), NOTHING, held[: (k + 1) * n], model.opt.timestep)
        for row in given.reshape(-1, DRIVES)[-n:]:
            data.ctrl[:] = row
            mujoco.mj_step(model, data)
        if not np.isfinite(data.qpos).all():
            raise DivergenceError(
                f"the controlled robot diverges at {(k + 1) * controller.period:.2f} s; lower the"
                " bandwidth of the controller"
            )
    return Controlled(currents, seen)
