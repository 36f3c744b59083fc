"""Geometry of the eight cables: lengths from the pose, and the pose back from the lengths.

    ᴬR_B = Rz(ψ) Ry(θ) Rx(φ)                  roll φ, pitch θ, yaw ψ        (thesis 2.1)
    d_i s_i = p + R b_i - a_i                 loop closure                  (2.6-2.8)
    ḋ_i = s_iᵀ (v + ω × R b_i)                                              (2.15)

Rows of the length Jacobian are [s_iᵀ, (R b_i × s_i)ᵀ] for v and ω in the frame O.
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from inca_mj.robot.geometry import Geometry

Array = np.ndarray


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation ᴬR_B = Rz Ry Rx of the platform (thesis 2.1).

    Args:
        roll: about x [rad].
        pitch: about y [rad].
        yaw: about z [rad].

    Returns:
        Shape (3, 3), without unit.
    """
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def quaternion(roll: float, pitch: float, yaw: float) -> Array:
    """Unit quaternion (w, x, y, z) of `rotation`, shape (4,)."""
    (cr, cp, cy), (sr, sp, sy) = (f(np.array([roll, pitch, yaw]) / 2) for f in (np.cos, np.sin))
    return np.array(
        [
            cy * cp * cr + sy * sp * sr,
            cy * cp * sr - sy * sp * cr,
            cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr,
        ]
    )


def euler(quaternions: Array) -> Array:
    """Roll, pitch, yaw [rad] of unit quaternions, shape (..., 4) -> (..., 3)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions), -1, 0)
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return np.stack([roll, pitch, yaw], -1)


def cables(position: Array, R: Array, geometry: Geometry) -> tuple[Array, Array]:
    """Lengths d (8,) [m] and unit vectors s (8, 3) from exit to connector (thesis 2.7, 2.8)."""
    span = position + geometry.B @ R.T - geometry.A
    d = np.linalg.norm(span, axis=1)
    return d, span / d[:, None]


def length_jacobian(position: Array, R: Array, geometry: Geometry) -> Array:
    """∂ḋ/∂(v, ω), d the cable lengths and v, ω in O (thesis 2.15).

    Args:
        position: of the platform in O, shape (3,) [m].
        R: rotation of the platform, shape (3, 3), without unit; see `rotation`.
        geometry: anchors of the cables.

    Returns:
        Shape (8, 6) [-, m].
    """
    _, s = cables(position, R, geometry)
    return np.hstack([s, np.cross(geometry.B @ R.T, s)])


def pose_from_lengths(
    lengths: Array, geometry: Geometry, start: Array, tolerance: float = 1e-10
) -> Array:  # fmt: skip
    """The pose whose cable lengths come nearest (least squares) to given ones, by Gauss-Newton.

    Args:
        lengths: cable lengths, shape (8,) [m].
        geometry: anchors of the cables.
        start: pose to begin at: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        tolerance: largest last step [m, rad].

    Returns:
        The pose, shape (6,).

    Raises:
        InputError: no pose was found; the lengths do not belong to this geometry.
    """
    position, R = np.array(start[:3], float), rotation(*start[3:])
    for _ in range(50):
        d, _ = cables(position, R, geometry)
        step = np.linalg.lstsq(length_jacobian(position, R, geometry), lengths - d, rcond=None)[0]
        position = position + step[:3]
        R = _turn(step[3:]) @ R
        if np.abs(step).max() < tolerance:
            pitch = np.arcsin(np.clip(-R[2, 0], -1, 1))
            angles = np.arctan2(R[2, 1], R[2, 2]), pitch, np.arctan2(R[1, 0], R[0, 0])
            return np.concatenate([position, angles])
    raise InputError(
        f"no pose of the platform has cable lengths {np.round(lengths, 3).tolist()} m;"
        " check the geometry and the sign of the motor angles (positive winds in)"
    )


def _turn(vector: Array) -> Array:
    """Rotation by a vector [rad] (Rodrigues), shape (3, 3)."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
