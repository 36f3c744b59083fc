"""The robot held at a pose by its currents: an operating point that is a rest.

    T = t₀ + W⁺ (w - W t₀)                  as at the start, for the pose (`inca_mj.twin.statics`)
    d₀ = λ d/(λ + T)                        (thesis 2.24, 2.25)
    φ = (1 + ε̄)(d₀(0) - d₀)/R               what the roller has wound in since the start
    K_t i = R T - R_s F_s(φ)                (thesis 2.40 at rest)

It is one robot everywhere: its drum springs balance the pretension of its own start pose, where
i = 0. φ and d₀ are states of their own, so that any φ is a rest with the right i; the one above is
that of a slow way from the start, with the mean ε̄ of the strains at both ends (thesis 2.30), and
errs by less than 1e-4 of φ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.linear.operating_points import OperatingPoints
from identification.linear.points import Points
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.parameters import pose_values
from inca_mj.robot.spread import at_drives
from inca_mj.twin.statics import start_from
from inca_mj.twin.twin import Twin, start_state

MOTORS, FIRST_ANGLE = slice(6, 6 + DRIVES), 7  # in qvel and qacc; in qpos
STILL = 1e-6  # [m/s², rad/s²]; pretension is exact to 1e-9 N on 1e-4 kg m²


def held_at(robot: Twin, poses: Sequence[Sequence[float]]) -> OperatingPoints:
    """Returns the robot at rest at some poses, with the currents that hold it there.

    Args:
        robot: the twin; its own start pose is that of its springs.
        poses: x, y, z [m], roll, pitch, yaw [rad], M of them.

    Raises:
        InputError: a pose is not six numbers within the robot's bounds, a cable would have to push
            there, or the cables cannot hold the platform.
        DivergenceError: the accelerations are not finite.
    """
    starts = [_start(robot, pose) for pose in poses]
    own = robot.start
    R = at_drives("R", robot.parameters.values())
    states = [start_state(begin) for begin in starts]
    qpos = np.array([s.qpos for s in states])
    for row, begin in zip(qpos, starts, strict=True):
        ε = (own.strain + begin.strain) / 2
        row[FIRST_ANGLE:] = (1 + ε) * (own.no_load_length - begin.no_load_length) / R
    robot.state()  # its law is installed
    point = OperatingPoints(
        model=robot.model,
        qpos=qpos,
        qvel=np.array([s.qvel for s in states]),
        act=np.array([s.act for s in states]),
        inputs=np.zeros((len(states), DRIVES)),
        time=np.zeros(len(states)),
    )
    at = Points(point)
    without, ones = at.rates(), at.rates(ctrl=np.ones_like(point.inputs))
    i = -without[:, MOTORS] / (ones - without)[:, MOTORS]
    _refuse_moving(at.rates(ctrl=i), poses)
    return replace(point, inputs=i)


def _start(robot: Twin, pose: Sequence[float]):  # type: ignore[no-untyped-def]
    values = robot.parameters.with_values(pose_values(pose)).values()
    return start_from(values, robot.geometry, robot.layout)


def _refuse_moving(rates: np.ndarray, poses: Sequence[Sequence[float]]) -> None:
    """Refuse states that do not rest under their currents."""
    moving = np.abs(rates[:, : MOTORS.stop]).max(axis=1)
    worst = int(moving.argmax())
    if not moving[worst] < STILL:
        raise InputError(
            f"the robot does not rest at pose {np.round(poses[worst], 4).tolist()}: an acceleration"
            f" of {moving[worst]:.3g} is left, because its effects act on the platform; build it"
            " with settled=True, or without them"
        )
