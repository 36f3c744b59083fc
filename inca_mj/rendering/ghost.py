"""What the real robot did, as positions of the twin's model, so that it can be drawn beside it.

    d_i = d_i(0) - R φ_i          the change of the cables' strain, about 0.1 mm, is neglected

The platform's pose is the one whose cable lengths come nearest to these.
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.forward import find
from inca_mj.kinematics.inverse_geometry import cables
from inca_mj.kinematics.rotations import euler_of, quaternion, rotation
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin


def poses_from_angles(robot: Twin, angles: np.ndarray) -> np.ndarray:
    """Platform poses from measured motor angles, each sample starting from the last.

    Args:
        robot: gives the geometry, the roller radius R and the start pose, where φ = 0.
        angles: motor angles φ, positive winds in, shape (N, 8) [rad].

    Returns:
        x, y, z [m], roll, pitch, yaw [rad], shape (N, 6).

    Raises:
        InputError: no pose has such cable lengths.
    """
    pose = np.array(robot.start.pose, float)
    position, R = pose[:3], rotation(*pose[3:])
    at_rest, _ = cables(position, R, robot.geometry)
    poses, σ = np.empty((len(angles), 6)), np.ones(DRIVES)
    for k, lengths in enumerate(at_rest - robot.parameters.values()["R"] * angles):
        position, R, _ = find(lengths, robot.geometry, (position, R), σ, tolerance=1e-7)
        poses[k] = np.concatenate([position, euler_of(R)])
    return poses


def ghost_positions(robot: Twin, angles: np.ndarray, poses: np.ndarray | None) -> np.ndarray:
    """MuJoCo positions of the measured robot, shape (N, 15) [m, -, rad].

    Args:
        robot: the twin.
        angles: measured motor angles, shape (N, 8) [rad].
        poses: measured poses x, y, z [m], roll, pitch, yaw [rad], shape (N, 6); from the angles
            when None.

    Raises:
        InputError: a shape is wrong, a number is not finite, or no pose has such cable lengths.
    """
    angles = _table(angles, "measured motor angles", DRIVES)
    poses = poses_from_angles(robot, angles) if poses is None else poses
    poses = _table(poses, "measured poses", 6)
    if len(poses) != len(angles):
        raise InputError(f"{len(poses)} measured poses for {len(angles)} samples of motor angles")
    turned = np.array([quaternion(*pose[3:]) for pose in poses])
    return np.hstack([poses[:, :3], turned, angles])


def _table(values: np.ndarray, what: str, columns: int) -> np.ndarray:
    table = np.asarray(values, float)
    if table.ndim != 2 or table.shape[1] != columns or not np.isfinite(table).all():
        raise InputError(
            f"{what} have shape {table.shape}; give finite numbers, {columns} in each row"
        )
    return table
