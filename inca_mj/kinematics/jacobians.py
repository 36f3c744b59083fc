"""The Jacobian of the cable lengths, its rate, and how well it is conditioned.

    ḋ = L (v, ω),     L_i = [s_iᵀ, (b_i × s_i)ᵀ]                              (thesis 2.15)
    d̈ = L (v̇, ω̇) + L̇ (v, ω),    L̇_i = [ṡ_iᵀ, (ḃ_i × s_i + b_i × ṡ_i)ᵀ]      (2.17 - 2.21)
    ṡ_i = H_i v_bi,   ḃ_i = ω × b_i

v and ω are along the axes of O. The forces of the cables on the platform are -Lᵀ T, so W = -Lᵀ is
the wrench matrix. The thesis does not write L as a matrix; its rows are 2.15, and the sum of
(2.20) is L̇ (v, ω) for one cable. Columns for ω are in metres: a condition number would depend on
the unit of length. So ω is counted times ρ, the mean distance of the connectors from P: then all
columns are without unit."""

from __future__ import annotations

import numpy as np

from inca_mj.kinematics.inverse_geometry import Cables
from inca_mj.kinematics.inverse_geometry import cables as straight_cables
from inca_mj.robot.geometry import Geometry

Array = np.ndarray

SMALLEST = 1e-9  # a singular value below this share of the largest one counts as zero


def length_jacobian(position: Array, R: Array, geometry: Geometry) -> Array:
    """Returns L = ∂ḋ/∂(v, ω), d the cable lengths and v, ω in O (thesis 2.15).

    Args:
        position: of the platform in O, shape (3,) [m].
        R: rotation of the platform, shape (3, 3), without unit; see `rotation`.
        geometry: anchors of the cables.

    Returns:
        Shape (8, 6) [-, m].
    """
    _, s = straight_cables(position, R, geometry)
    return np.hstack([s, np.cross(geometry.B @ R.T, s)])


def jacobian(cables: Cables) -> Array:
    """Returns L = ∂ḋ/∂(v, ω) at one pose or many, also over pulleys (thesis 2.15).

    Args:
        cables: of a pose, from `inverse`.

    Returns:
        Shape (..., 8, 6) [-, m].
    """
    s = cables.directions
    return np.concatenate([s, np.cross(cables.arms, s)], -1)


def jacobian_rate(cables: Cables, twist: Array) -> Array:
    """Returns L̇ of a platform that moves.

    Args:
        cables: of a pose, from `inverse`.
        twist: v and ω of the platform, along O, shape (..., 6) [m/s, rad/s].

    Returns:
        Shape (..., 8, 6) [1/s, m/s].
    """
    twist = np.asarray(twist, float)
    b, s = cables.arms, cables.directions
    b_rate = np.cross(twist[..., None, 3:], b)
    s_rate = (cables.bends @ (twist[..., None, :3] + b_rate)[..., None])[..., 0]
    return np.concatenate([s_rate, np.cross(b_rate, s) + np.cross(b, s_rate)], -1)


def singular_values(cables: Cables) -> Array:
    """Returns the singular values of L with ω times ρ, the largest first.

    Args:
        cables: of a pose, from `inverse`.

    Returns:
        Shape (..., 6), without unit.
    """
    ρ = np.linalg.norm(cables.arms, axis=-1).mean(-1)[..., None, None]
    L = jacobian(cables)
    return np.linalg.svd(np.concatenate([L[..., :3], L[..., 3:] / ρ], -1), compute_uv=False)


def rank(cables: Cables) -> int:
    """Returns how many motions of the platform the lengths can tell, 6 if the pose is determined.

    Args:
        cables: of one pose.
    """
    σ = singular_values(cables)
    return int(np.sum(σ > SMALLEST * σ[0]))


def condition(cables: Cables) -> float:
    """Returns the condition number of L with ω times ρ; infinite in a singular pose.

    Args:
        cables: of one pose.
    """
    σ = singular_values(cables)
    return float(σ[0] / σ[-1]) if rank(cables) == len(σ) else float("inf")
