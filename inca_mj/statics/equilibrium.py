"""The rest of the platform under constant currents, by default with the power off.

    W(x) T(x) + f = 0,   f = weight and load;   T_i from the drum in balance (see `robot.pull`)

It is solved for the pose by Newton steps with the stiffness of the free drums, halved until the
wrench that is left becomes smaller. With the power off and no load the solution is the start pose,
because the springs balance the pretension there.

Coulomb friction lets the real robot stop anywhere near: a drum at rest holds ±b_c/R of tension,

    |δx| ≤ |K⁻¹ W| b_c/R        componentwise, the band in which friction may hold it.

The smooth friction of the model, b_c tanh(β ω), is zero at rest, and the model creeps to the
middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from identification.errors import InputError
from inca_mj.kinematics.cables import inverse
from inca_mj.kinematics.rotations import pose_rotation
from inca_mj.robot.elastic import Robot
from inca_mj.statics.robot import Pull, pull
from inca_mj.statics.stiffness import stiffness

STEPS, HALVINGS = 100, 30
BALANCED = 1e-10  # largest force [N] or torque [N m] that may be left
LONGEST = 0.3  # a Newton step moves and turns no farther [m, rad]
NONE = np.zeros(6)


@dataclass(frozen=True)
class Equilibrium:
    """The robot at rest."""

    pose: np.ndarray  # x, y, z [m], roll, pitch, yaw [rad], shape (6,)
    tension: np.ndarray  # T, shape (8,) [N]
    angle: np.ndarray  # φ, shape (8,) [rad]
    no_load: np.ndarray  # d₀, shape (8,) [m]
    stiffness: np.ndarray  # K with free drums, shape (6, 6) [N/m, N, N m/rad]
    stable: bool  # whether every small displacement is driven back
    # how far from this pose Coulomb friction may hold it, along x, y, z [m] and about them [rad],
    # shape (6,)
    friction_band: np.ndarray


def equilibrium(
    robot: Robot, current: float | np.ndarray = 0.0, load: np.ndarray = NONE
) -> Equilibrium:
    """Returns the rest near the start pose, under constant currents and a constant load.

    Args:
        robot: its numbers.
        current: of the motors, one number or shape (8,) [A]; 0 is the power off.
        load: wrench on the platform beside its weight, in O at its centre, shape (6,) [N, N m].

    Raises:
        InputError: a number is not finite, no rest is near, it is outside the frame, or a cable is
            slack there.
    """
    current, load = np.asarray(current, float), np.asarray(load, float)
    if load.shape != (6,) or current.shape not in ((), (8,)):
        raise InputError(
            f"a load of shape {load.shape} and currents of shape {current.shape}; give six numbers"
            " [N, N m], and one current or eight [A]"
        )
    if not (np.isfinite(load).all() and np.isfinite(current).all()):
        raise InputError("loads and currents must be finite numbers")
    pose = _solve(robot, current, load)
    low, high = robot.geometry.A.min(axis=0), robot.geometry.A.max(axis=0)
    if not ((low < pose[:3]) & (pose[:3] < high)).all():
        raise InputError(
            f"the platform would rest at {np.round(pose[:3], 3).tolist()} m, outside the frame,"
            f" whose exit points span {low.tolist()} to {high.tolist()} m; give a smaller load"
        )
    at = inverse(pose, robot.geometry)
    found = pull(robot, at.lengths, current)
    if found.tension.min() <= 0:
        raise InputError(
            f"cable {found.tension.argmin() + 1} is slack where the platform would rest,"
            f" {np.round(pose, 4).tolist()}; give a smaller load, or currents that wind it in"
        )
    K = stiffness(at, found.tension, found.stiffness)
    stable = bool(np.linalg.eigvalsh((K + K.T) / 2)[0] > 0)
    band = np.abs(np.linalg.solve(K, at.W)) @ (robot.b_c / robot.R)
    return Equilibrium(pose, found.tension, found.angle, found.no_load, K, stable, band)


def _solve(robot: Robot, current: np.ndarray, load: np.ndarray) -> np.ndarray:
    pose = robot.start
    left, K = _left(robot, pose, current, load)
    for _ in range(STEPS):
        if np.abs(left).max() < BALANCED:
            return pose
        step = np.linalg.lstsq(K, left, rcond=None)[0]
        step = step / max(1.0, np.abs(step).max() / LONGEST)
        for _ in range(HALVINGS):
            tried = moved(pose, step)
            then = _left(robot, tried, current, load)
            if _size(then[0]) < _size(left):
                break
            step = step / 2
        else:
            break
        pose, (left, K) = tried, then
    if np.abs(left).max() < 1e3 * BALANCED:  # rounding forbids a smaller rest
        return pose
    raise InputError(
        f"no rest near the start under load {np.round(load, 3).tolist()} [N, N m]: the search ended"
        f" at pose {np.round(pose, 3).tolist()} with {np.abs(left[:3]).max():.2g} N left; give a"
        " smaller load, or currents that hold it"
    )


def _left(
    robot: Robot, pose: np.ndarray, current: np.ndarray, load: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the wrench that is left, and K."""
    at = inverse(pose, robot.geometry)
    found: Pull = pull(robot, at.lengths, current)
    left = at.W @ found.tension - robot.weight + load
    return left, stiffness(at, found.tension, found.stiffness)


def _size(left: np.ndarray) -> float:
    return float(np.linalg.norm(left[:3]) + np.linalg.norm(left[3:]) / 0.05)  # arms of 5 cm


def moved(pose: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Returns a pose (6,) after a small displacement [m] and rotation vector [rad] in O, (6,)."""
    turned = Rotation.from_rotvec(x[3:]) * Rotation.from_matrix(pose_rotation(pose))
    return np.concatenate([pose[:3] + x[:3], turned.as_euler("ZYX")[::-1]])
