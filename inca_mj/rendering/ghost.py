"""The measured robot as positions of the twin's model, so that it can be drawn beside it.

In a close view it is drawn farther from the simulated robot than it is, by a round factor k:

    p = p_s + k (p_m - p_o)              s: simulated, drawn where it is; m: measured
    R = exp(k log(R_m R_oᵀ)) R_s         o: simulated, its pose taken as that of the measured one

A difference of 1 mm is a pixel even close up. Of films side by side k is the same in all pictures,
so that what is drawn compares as what is written.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from scipy.spatial.transform import Rotation

from identification.errors import InputError
from inca_mj.kinematics.rotations import quaternion
from inca_mj.kinematics.stiff import poses_with_stiff_cables
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin

ROOM = 0.12  # how far a part of the handle may be drawn from where it is [m]
_LEVER = 0.12  # length of the handle, at which a turn counts [m]
_MOST = 1000.0  # of a difference that hardly is one
_EACH = (1, 2, 5)


def ghost_positions(robot: Twin, angles: np.ndarray, poses: np.ndarray | None) -> np.ndarray:
    """Returns MuJoCo positions of the measured robot, shape (N, 15) [m, -, rad].

    Angles (N, 8) [rad] and poses (N, 6) [m, rad] are measured; poses follow from the angles when
    None. Raises InputError if a shape is wrong, a number is not finite, or no pose has such cable
    lengths.
    """
    angles = _table(angles, "measured motor angles", DRIVES)
    if poses is None:
        R, start = robot.parameters.values()["R"], np.array(robot.start.pose, float)
        poses = poses_with_stiff_cables(angles, R, start, robot.geometry)
    poses = _table(poses, "measured poses", 6)
    if len(poses) != len(angles):
        raise InputError(f"{len(poses)} measured poses for {len(angles)} samples of motor angles")
    turned = np.array([quaternion(*pose[3:]) for pose in poses])
    return np.hstack([poses[:, :3], turned, angles])


def ghost_difference(
    robot: Twin, simulated: np.ndarray, ghost: np.ndarray, is_pose_measured: bool
) -> Difference:
    """Returns a simulated robot beside the measured one; both are positions (N, 15) [m, -, rad].

    If the pose of the ghost was not measured, it follows from the angles for cables that do not
    stretch, and that of the simulated robot is taken so too.
    """
    own = simulated if is_pose_measured else ghost_positions(robot, simulated[:, 7:], None)
    return Difference(simulated, own, ghost)


@dataclass(frozen=True)
class Difference:
    """Poses of a simulated and of the measured robot."""

    simulated: np.ndarray  # MuJoCo positions of the simulated robot, shape (N, 15) [m, -, rad]
    # the same, its pose taken in the way in which that of the measured robot is known
    own: np.ndarray
    measured: np.ndarray  # positions of the measured one, shape (N, 15)

    @property
    def moved(self) -> np.ndarray:
        """Displacement of the measured platform, shape (N, 3) [m]."""
        return np.asarray(self.measured[:, :3] - self.own[:, :3])

    @property
    def turned(self) -> np.ndarray:
        """Rotation vector of the measured platform, shape (N, 3) [rad]."""
        return np.asarray((_rotation(self.measured) * _rotation(self.own).inv()).as_rotvec())

    @property
    def errors(self) -> np.ndarray:
        """Distances of the platforms [m] and rms errors of the motor angles [rad], shape (N, 2)."""
        angles = self.simulated[:, 7:] - self.measured[:, 7:]
        distance = np.linalg.norm(self.moved, axis=1)
        return np.stack([distance, np.sqrt(np.mean(angles**2, axis=1))], axis=1)

    @property
    def largest(self) -> float:
        """The farthest that a part of the handle is off at any time [m]."""
        length = np.linalg.norm(self.moved, axis=1)
        return float(np.max(length + _LEVER * np.linalg.norm(self.turned, axis=1)))

    def enlarged(self, times: float) -> np.ndarray:
        """Returns positions of the measured robot, its difference magnified, shape (N, 15)."""
        out = self.measured.copy()
        out[:, :3] = self.simulated[:, :3] + times * self.moved
        turned = Rotation.from_rotvec(times * self.turned) * _rotation(self.simulated)
        out[:, 3:7] = turned.as_quat(scalar_first=True)
        return out


def common_factor(each: Sequence[Difference]) -> float:
    """Returns the largest of 1, 2, 5, 10, ... with which all differences fit in a close view."""
    largest = max(one.largest for one in each)
    if largest * _MOST <= ROOM:
        return _MOST
    power = floor(log10(ROOM / largest))
    fits = [k * 10.0**power for k in _EACH if k * 10.0**power * largest <= ROOM]
    return max(1.0, *fits)


def _table(values: np.ndarray, what: str, columns: int) -> np.ndarray:
    table = np.asarray(values, float)
    if table.ndim != 2 or table.shape[1] != columns or not np.isfinite(table).all():
        raise InputError(
            f"{what} have shape {table.shape}; give finite numbers, {columns} in each row"
        )
    return table


def _rotation(positions: np.ndarray) -> Rotation:
    return Rotation.from_quat(positions[:, 3:7], scalar_first=True)
