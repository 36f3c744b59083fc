"""Poses along a log as if the cables did not stretch: quick, and good to a tenth of a millimetre.

    d_i = d_i(0) - R φ_i          the change of the cables' strain is neglected

The platform's pose is the one whose cable lengths come nearest to these. (`along` knows the
strain, and gives the std of each pose.)
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.forward import find
from inca_mj.kinematics.inverse_geometry import cables
from inca_mj.kinematics.rotations import euler_of, rotation
from inca_mj.robot.geometry import DRIVES, Geometry

FINE = 1e-7  # last step of a search that has ended [m, rad]
LOST = 1.0  # by which exchanged or turned angles still miss no length, in a frame of 3 m [m]


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
        InputError: no pose has nearly such cable lengths.
    """
    position, turned = np.array(start[:3], float), rotation(*start[3:])
    at_rest, _ = cables(position, turned, geometry)
    poses, σ = np.empty((len(angles), 6)), np.ones(DRIVES)
    for k, lengths in enumerate(at_rest - R * angles):
        position, turned, last = find(lengths, geometry, (position, turned), σ, tolerance=FINE)
        if last >= FINE:  # the search took all its steps, as it would at each sample that follows
            _refuse_lost(cables(position, turned, geometry)[0] - lengths, k)
        poses[k] = np.concatenate([position, euler_of(turned)])
    return poses


def _refuse_lost(missed: np.ndarray, sample: int) -> None:
    """Refuse angles of which the nearest pose misses lengths by more than a log's errors do.

    Args:
        missed: lengths of that pose minus those of the angles, shape (8,) [m].
        sample: of the log.
    """
    worst = int(np.abs(missed).argmax())
    if abs(missed[worst]) > LOST:
        raise InputError(
            f"no pose of the platform has the cable lengths that the motor angles of sample"
            f" {sample + 1} give: the nearest one misses cable {worst + 1} by"
            f" {abs(missed[worst]):.3g} m; check the unit of the angles (rad), and their signs"
            " (positive winds in)"
        )
