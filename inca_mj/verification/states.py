"""One state, two ways of writing it.

    reference (36)     p, v along BODY axes, Euler angles, ω, φ, ω_m, d₀
    MuJoCo             qpos = p, quaternion, φ    qvel = v along O, ω, ω_m    act = d₀

MuJoCo's free joint, too, has its angular velocity along the body axes.
"""

from __future__ import annotations

import numpy as np

from identification.model.rollout import State
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.rotations import quaternion, rotation
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import DRIVES, Geometry

STRETCH = 1e-3  # cables are strained and slackened up to this strain: tensions of some 10 N


def to_mujoco(x: np.ndarray) -> State:
    """Returns states of the reference, shape (n, 36), as states of the twin."""
    rows = np.atleast_2d(x)
    v = [rotation(*row[at.EULER]) @ row[at.VELOCITY] for row in rows]
    q = [quaternion(*row[at.EULER]) for row in rows]
    return State(
        qpos=np.hstack([rows[:, at.POSITION], q, rows[:, at.ANGLES]]),
        qvel=np.hstack([v, rows[:, at.RATES], rows[:, at.SPEEDS]]),
        act=rows[:, at.NO_LOAD].copy(),
    )


def random_states(n: int, geometry: Geometry, rng: np.random.Generator) -> np.ndarray:
    """Returns states far from rest, shape (n, 36); about half of the cables are slack.

    Positions within the middle two thirds of the frame, angles to 60°, and velocities as the
    robot's fastest motions have them.
    """
    x = np.empty((n, at.STATES))
    low, high = geometry.A.min(axis=0), geometry.A.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 3
    x[:, at.POSITION] = rng.uniform(middle - half, middle + half, (n, 3))
    x[:, at.VELOCITY] = rng.normal(0, 1, (n, 3))
    x[:, at.EULER] = rng.uniform(-np.pi / 3, np.pi / 3, (n, 3))
    x[:, at.RATES] = rng.normal(0, 5, (n, 3))
    x[:, at.ANGLES] = rng.normal(0, 50, (n, DRIVES))
    x[:, at.SPEEDS] = rng.normal(0, 20, (n, DRIVES))
    d = [cables_at(row[at.POSITION], rotation(*row[at.EULER]), geometry).lengths for row in x]
    x[:, at.NO_LOAD] = d / (1 + rng.uniform(-STRETCH, STRETCH, (n, DRIVES)))
    return x
