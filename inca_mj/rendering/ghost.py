"""The measured robot as positions of the twin's model, so that it can be drawn beside it."""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.rotations import quaternion
from inca_mj.kinematics.stiff import poses_with_stiff_cables
from inca_mj.rendering.difference import Difference
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin


def ghost_positions(robot: Twin, angles: np.ndarray, poses: np.ndarray | None) -> np.ndarray:
    """Returns MuJoCo positions of the measured robot, shape (N, 15) [m, -, rad].

    Args:
        robot: the twin.
        angles: measured motor angles, shape (N, 8) [rad].
        poses: measured poses x, y, z [m], roll, pitch, yaw [rad], shape (N, 6); from the angles
            when None.

    Raises:
        InputError: a shape is wrong, a number is not finite, or no pose has such cable lengths.
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
    """Returns a simulated robot beside the measured one.

    Args:
        robot: the twin.
        simulated: MuJoCo positions of the simulated robot, shape (N, 15) [m, -, rad].
        ghost: of the measured one, shape (N, 15).
        is_pose_measured: whether the pose of the ghost was measured; else it follows from the
            angles for cables that do not stretch, and that of the simulated robot is taken so too.
    """
    own = simulated if is_pose_measured else ghost_positions(robot, simulated[:, 7:], None)
    return Difference(simulated, own, ghost)


def ghost_errors(off: Difference) -> tuple[np.ndarray, np.ndarray]:
    """Returns how far a simulated robot is from the measured one, sample by sample.

    Args:
        off: both robots.

    Returns:
        The distance of the platform, shape (N,) [m], and the rms of the eight motor angles' errors,
        shape (N,) [rad].
    """
    distance = np.linalg.norm(off.moved, axis=1)
    turned = np.sqrt(np.mean((off.simulated[:, 7:] - off.measured[:, 7:]) ** 2, axis=1))
    return distance, turned


def _table(values: np.ndarray, what: str, columns: int) -> np.ndarray:
    table = np.asarray(values, float)
    if table.ndim != 2 or table.shape[1] != columns or not np.isfinite(table).all():
        raise InputError(
            f"{what} have shape {table.shape}; give finite numbers, {columns} in each row"
        )
    return table
