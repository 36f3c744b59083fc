"""How lengths and directions of the cables change as the platform moves: Jacobian, rates, turns.

    ḋ = L (v, ω),     L_i = [s_iᵀ, (b_i × s_i)ᵀ]                              (thesis 2.15)
    d̈ = L (v̇, ω̇) + L̇ (v, ω),    L̇_i = [ṡ_iᵀ, (ḃ_i × s_i + b_i × ṡ_i)ᵀ]      (2.17 - 2.21)
    ṡ_i = H_i v_bi,   ḃ_i = ω × b_i

A twist is (v, ω), both along the axes of O. The forces of the cables on the platform are -Lᵀ T, so
W = -Lᵀ is the wrench matrix. The thesis does not write L as a matrix; its rows are 2.15, and the
sum of (2.20) is L̇ (v, ω) for one cable. Columns for ω are in metres: a condition number would
depend on the unit of length. So ω is counted times ρ, the mean distance of the connectors from P:
then all columns are without unit.

Rates in the frames of the cables:

    v_bi = v_p + ω_p × b_i = d_i ω_i × s_i + ḋ_i s_i         connector                (2.11, 2.13)
    ⁱv_bi = ᴬR_iᵀ v_bi,   ḋ_i = ⁱv_biz                       in the frame of the cable (2.12, 2.14)
    ⁱω_i = (ⁱs_i × ⁱv_bi)/d_i = (-ⁱv_biy, ⁱv_bix, 0)/d_i     the cable does not spin         (2.16)

    v̇_bi = v̇_p + ω̇_p × b_i + ω_p × (ω_p × b_i)               connector                       (2.17)
    v̇_bi = d̈ s + d ω̇ × s + d ω × (ω × s) + 2 ḋ ω × s,   ⁱv̇_bi = ᴬR_iᵀ v̇_bi           (2.18, 2.19)
    d̈_i = ⁱv̇_biz + d_i |ω_i|² = ⁱv̇_biz + (ⁱv_bix² + ⁱv_biy²)/d_i                     (2.20, 2.21)
    ⁱω̇_i = (ⁱs_i × ⁱv̇_bi - 2 ḋ_i ⁱω_i)/d_i                   the cable turns                 (2.22)

Misprints of the thesis: 2.16 lacks the minus of its first entry; 2.20 writes ω_i² for the square of
the vector's length, and 2.21 says the same without doubt. ⁱω_i is the rate of the line from A_i to
B_i; its frame also spins about it, by φ̇_i cos θ_i. With pulleys ω_i = s_i × H_i v_bi, which is the
same thing for a straight cable; the accelerations are those of straight cables.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.cables import Cables, cables_at
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

    Raises:
        InputError: a cable has no length.
    """
    return jacobian(cables_at(position, R, geometry))


def jacobian(cables: Cables) -> Array:
    """Returns L = ∂ḋ/∂(v, ω) at one pose or many, also over pulleys (thesis 2.15).

    Args:
        cables: of a pose, from `inverse`.

    Returns:
        Shape (..., 8, 6) [-, m].
    """
    return cables.L


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
    """Returns the singular values of L with ω times ρ, largest first, (..., 6), without unit."""
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


@dataclass(frozen=True)
class CableRates:
    """Rates of the connectors, of the lengths, and of the cables' turning.

    Attributes:
        connectors: v_bi, in O, shape (..., 8, 3) [m/s].
        lengths: ḋ_i, shape (..., 8) [m/s].
        turns: ⁱω_i, in the frame of the cable, shape (..., 8, 3) [rad/s].
    """

    connectors: Array
    lengths: Array
    turns: Array


def rates(cables: Cables, twist: Array) -> CableRates:
    """Returns the rates of the cables (thesis 2.11 - 2.16).

    Args:
        cables: of a pose, from `inverse`.
        twist: v_p and ω_p of the platform, along O, shape (..., 6) [m/s, rad/s].
    """
    twist = np.asarray(twist, float)
    v, ω = twist[..., None, :3], twist[..., None, 3:]
    v_b = v + np.cross(ω, cables.arms)
    s_rate = np.einsum("...ij,...j->...i", cables.bends, v_b)
    return CableRates(
        connectors=v_b,
        lengths=np.sum(cables.directions * v_b, -1),
        turns=into_frames(cables, np.cross(cables.directions, s_rate)),
    )


def into_frames(cables: Cables, vectors: Array) -> Array:
    """Returns ᴬR_iᵀ a_i: vectors in O, shape (..., 8, 3), along the axes of each cable's frame."""
    return np.einsum("...ji,...j->...i", cables.frames, vectors)


@dataclass(frozen=True)
class CableAccelerations:
    """Accelerations of the connectors, of the lengths, and of the cables' turning.

    Attributes:
        connectors: v̇_bi, in O, shape (..., 8, 3) [m/s^2].
        lengths: d̈_i, shape (..., 8) [m/s^2].
        turns: ⁱω̇_i, in the frame of the cable, shape (..., 8, 3) [rad/s^2].
    """

    connectors: Array
    lengths: Array
    turns: Array


def accelerations(cables: Cables, twist: Array, twist_rate: Array) -> CableAccelerations:
    """Returns the accelerations of straight cables (thesis 2.17 - 2.22).

    Args:
        cables: of a pose, from `inverse`.
        twist: v_p and ω_p of the platform, along O, shape (..., 6) [m/s, rad/s].
        twist_rate: v̇_p and ω̇_p, along O, shape (..., 6) [m/s^2, rad/s^2].

    Raises:
        InputError: the cables run over pulleys.
    """
    if cables.pulleys is not None:
        raise InputError(
            "these accelerations are those of straight cables; use jacobian_rate with pulleys"
        )
    twist, twist_rate = np.asarray(twist, float), np.asarray(twist_rate, float)
    ω, b, d = twist[..., None, 3:], cables.arms, cables.lengths
    moved = rates(cables, twist)
    v_b_rate = (
        twist_rate[..., None, :3]
        + np.cross(twist_rate[..., None, 3:], b)
        + np.cross(ω, np.cross(ω, b))
    )
    ax, ay, az = np.moveaxis(into_frames(cables, v_b_rate), -1, 0)
    vx, vy, _ = np.moveaxis(into_frames(cables, moved.connectors), -1, 0)
    s_cross_a = np.stack([-ay, ax, np.zeros_like(ax)], -1)
    return CableAccelerations(
        connectors=v_b_rate,
        lengths=az + (vx**2 + vy**2) / d,
        turns=(s_cross_a - 2 * moved.lengths[..., None] * moved.turns) / d[..., None],
    )
