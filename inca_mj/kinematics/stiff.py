"""Poses along a log as if the cables did not stretch: quick, and good to a tenth of a millimetre.

    d_i = d_i(0) - R φ_i          the change of the cables' strain is neglected

The platform's pose is the one whose cable lengths come nearest to these. (`along` knows the
strain, and gives the std of each pose.)
"""

from __future__ import annotations

import numpy as np

from inca_mj.kinematics.forward import find
from inca_mj.kinematics.inverse_geometry import cables
from inca_mj.kinematics.rotations import euler_of, rotation
from inca_mj.robot.geometry import DRIVES, Geometry


def poses_with_stiff_cables(
    angles: np.ndarray, R: float | np.ndarray, start: np.ndarray, geometry: Geometry
) -> np.ndarray:
    """Platform poses from motor angles, each sample starting from the last.

    Args:
        angles: motor angles φ, positive winds in, shape (N, 8) [rad].
        R: radius of the rollers, of all or of each, shape (8,) [m].
        start: the pose where φ = 0: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        geometry: exit points and connectors.

    Returns:
        x, y, z [m], roll, pitch, yaw [rad], shape (N, 6).

    Raises:
        InputError: no pose has such cable lengths.
    """
    position, turned = np.array(start[:3], float), rotation(*start[3:])
    at_rest, _ = cables(position, turned, geometry)
    poses, σ = np.empty((len(angles), 6)), np.ones(DRIVES)
    for k, lengths in enumerate(at_rest - R * angles):
        position, turned, _ = find(lengths, geometry, (position, turned), σ, tolerance=1e-7)
        poses[k] = np.concatenate([position, euler_of(turned)])
    return poses
