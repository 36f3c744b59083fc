"""Rotations of the platform, and how fast its roll, pitch and yaw change.

    ᴬR_B = Rz(ψ) Ry(θ) Rx(φ)                  roll φ, pitch θ, yaw ψ                  (thesis 2.1)
    ᴮω = J⁻¹ [φ̇ θ̇ ψ̇]ᵀ,    J⁻¹ = [x, Rxᵀ y, Rxᵀ Ryᵀ z]                                 (2.2 - 2.4)
    [φ̇ θ̇ ψ̇]ᵀ = J ᴮω,      J = [[1, sφ tθ, cφ tθ], [0, cφ, -sφ], [0, sφ/cθ, cφ/cθ]]         (2.5)

ᴮω are the rates of the platform along its own axes; along the axes of O they are ω = ᴬR_B ᴮω.

Misprints of the thesis, and what stands here: 2.3 lacks the transposes of its two rotations; 2.5
has sin φ for cos φ in its second row and column. At a pitch of ±90° roll and yaw are one angle
and J has no values; `euler_rate_matrix` refuses it.

A pose is x, y, z [m], roll, pitch, yaw [rad]. All functions take one or many: leading dimensions
are kept."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from identification.errors import InputError

Array = np.ndarray

UPRIGHT = 1e-9  # a smaller |cos θ| means that the platform stands at a pitch of 90 degrees


def rotation(roll: float | Array, pitch: float | Array, yaw: float | Array) -> Array:
    """Returns the rotation ᴬR_B = Rz Ry Rx of the platform (thesis 2.1).

    Args:
        roll: about x, shape (...) [rad].
        pitch: about y, shape (...) [rad].
        yaw: about z, shape (...) [rad].

    Returns:
        Shape (..., 3, 3), without unit.
    """
    angles = np.stack(np.broadcast_arrays(roll, pitch, yaw)).astype(float)
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles), np.sin(angles)
    rows = (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )
    return _matrix(rows)


def pose_rotation(pose: Array) -> Array:
    """Returns `rotation` of poses, shape (..., 6) [m, rad] -> (..., 3, 3)."""
    return rotation(*np.moveaxis(np.asarray(pose, float)[..., 3:], -1, 0))


def quaternion(roll: float, pitch: float, yaw: float) -> Array:
    """Returns the unit quaternion (w, x, y, z) of `rotation`.

    Args:
        roll: about x [rad].
        pitch: about y [rad].
        yaw: about z [rad].

    Returns:
        Shape (4,), without unit.
    """
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
    """Returns roll, pitch, yaw [rad] of unit quaternions, shape (..., 4) -> (..., 3)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions), -1, 0)
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return np.stack([roll, pitch, yaw], -1)


def euler_of(R: Array) -> Array:
    """Returns roll, pitch, yaw [rad] of rotations, shape (..., 3, 3) -> (..., 3)."""
    roll = np.arctan2(R[..., 2, 1], R[..., 2, 2])
    pitch = np.arcsin(np.clip(-R[..., 2, 0], -1, 1))
    yaw = np.arctan2(R[..., 1, 0], R[..., 0, 0])
    return np.stack([roll, pitch, yaw], -1)


def cross_matrix(vectors: Array) -> Array:
    """Returns [v]×, with [v]× u = v × u, shape (..., 3) -> (..., 3, 3)."""
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    o = np.zeros_like(x)
    rows = ((o, -z, y), (z, o, -x), (-y, x, o))
    return _matrix(rows)


def turn(vectors: Array) -> Array:
    """Returns rotations by vectors [rad] (Rodrigues), shape (..., 3) -> (..., 3, 3)."""
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    K = cross_matrix(vectors)
    # sin(a)/a and (1 - cos a)/a², which stay finite at a = 0
    return (
        np.eye(3) + np.sinc(angle / np.pi) * K + 0.5 * np.sinc(angle / (2 * np.pi)) ** 2 * (K @ K)
    )


def body_rate_matrix(pose: Array) -> Array:
    """Returns J⁻¹ of ᴮω = J⁻¹ [φ̇ θ̇ ψ̇]ᵀ (thesis 2.4).

    Args:
        pose: shape (..., 6) [m, rad].

    Returns:
        Shape (..., 3, 3), without unit.
    """
    roll, pitch, _ = np.moveaxis(np.asarray(pose, float)[..., 3:], -1, 0)
    sr, cr, sp, cp = np.sin(roll), np.cos(roll), np.sin(pitch), np.cos(pitch)
    o, one = np.zeros_like(roll), np.ones_like(roll)
    rows = ((one, o, -sp), (o, cr, sr * cp), (o, -sr, cr * cp))
    return _matrix(rows)


def euler_rate_matrix(pose: Array) -> Array:
    """Returns J of [φ̇ θ̇ ψ̇]ᵀ = J ᴮω (thesis 2.5, corrected).

    Args:
        pose: shape (..., 6) [m, rad].

    Returns:
        Shape (..., 3, 3), without unit.

    Raises:
        InputError: the pitch is ±90 degrees, where roll and yaw are one angle.
    """
    roll, pitch, _ = np.moveaxis(np.asarray(pose, float)[..., 3:], -1, 0)
    sr, cr, sp, cp = np.sin(roll), np.cos(roll), np.sin(pitch), np.cos(pitch)
    if np.abs(cp).min(initial=1.0) < UPRIGHT:
        raise InputError(
            "at a pitch of 90 degrees roll and yaw are one angle, so their rates are not known;"
            " give another pitch, or use the rates of the body"
        )
    o, one = np.zeros_like(roll), np.ones_like(roll)
    rows = ((one, sr * sp / cp, cr * sp / cp), (o, cr, -sr), (o, sr / cp, cr / cp))
    return _matrix(rows)


def pose_rate_matrix(pose: Array) -> Array:
    """Returns E of d(pose)/dt = E (v, ω), with v and ω along the axes of O (thesis 2.5).

    Args:
        pose: shape (..., 6) [m, rad].

    Returns:
        Shape (..., 6, 6), without unit.

    Raises:
        InputError: the pitch is ±90 degrees.
    """
    R = pose_rotation(pose)
    E = np.zeros((*R.shape[:-2], 6, 6))
    E[..., :3, :3] = np.eye(3)
    E[..., 3:, 3:] = euler_rate_matrix(pose) @ np.swapaxes(R, -1, -2)
    return E


def _matrix(rows: Iterable[Iterable[Array]]) -> Array:
    """Returns matrices of entries, each of shape (...), shape (..., rows, columns)."""
    return np.stack([np.stack([*row], -1) for row in rows], -2)
