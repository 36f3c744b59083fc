"""Kinematics of the eight cables, thesis sections 2.2.1 to 2.2.3, in the fixed frame O.

The right-hand side needs only d and ḋ; directions, cable rates and accelerations are here for
readers and tests. Frame i of a cable has its z along s_i, from A_i to B_i.

    a + d s = p + b,  b = R_AB ᴮb                                             (2.6 - 2.8)
    R_Ai = Rz(φ_i) Ry(θ_i),  s = R_Ai (0, 0, 1)ᵀ                             (2.9, 2.10)
    v_b = v_p + ω_p × b,  ⁱv_b = R_Aiᵀ v_b                                   (2.11, 2.12)
    ḋ = ⁱv_bz = sᵀ v_b                                                       (2.14, 2.15)
    ⁱω = (ⁱs × ⁱv_b)/d = (−ⁱv_by, ⁱv_bx, 0)/d                                     (2.16)
    v̇_b = v̇_p + ω̇_p × b + ω_p × (ω_p × b),  ⁱv̇_b = R_Aiᵀ v̇_b                 (2.17, 2.18)
    d̈ = ⁱv̇_bz + (ⁱv_bx² + ⁱv_by²)/d                                          (2.20, 2.21)
    ⁱω̇ = (ⁱs × ⁱv̇_b − 2 ḋ ⁱω)/d                                                   (2.22)

Misprint: 2.16 lacks the minus of its first entry. ⁱω is the rate of the line A_i B_i, which does
not spin about itself; frame i does (by φ̇_i cos θ_i), so ⁱω is not the rate of frame i.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.reference import equations
from inca_mj.robot.geometry import Geometry


@dataclass(frozen=True)
class CablePose:
    """The arms, lengths, directions and frames of the cables."""

    arms: np.ndarray  # b_i, from P to B_i, in O, shape (8, 3) [m]
    lengths: np.ndarray  # d_i, shape (8,) [m]
    directions: np.ndarray  # s_i, from A_i to B_i, in O, shape (8, 3)
    angles: np.ndarray  # (φ_i, θ_i), shape (8, 2) [rad]; φ_i = 0 for a vertical cable
    frames: np.ndarray  # R_Ai, from frame i to O, shape (8, 3, 3)


@dataclass(frozen=True)
class CableMotion:
    """The motion of the cables: a velocity analysis, or an acceleration analysis."""

    connectors: np.ndarray  # v_b (or v̇_b) of B_i, in O, shape (8, 3) [m/s] ([m/s^2])
    lengths: np.ndarray  # ḋ (or d̈), shape (8,) [m/s] ([m/s^2])
    # ω (or ω̇) of the line of the cable, in frame i, shape (8, 3) [rad/s] ([rad/s^2])
    turns: np.ndarray


def rotation(euler: np.ndarray) -> np.ndarray:
    """Returns R_AB from roll, pitch, yaw [rad], shape (3, 3) (2.1)."""
    return np.array(list(equations.rotation(equations.vector(np.asarray(euler, float)))))


def euler_rate_matrix(euler: np.ndarray) -> np.ndarray:
    """Returns J of [φ̇ θ̇ ψ̇]ᵀ = J ω, shape (3, 3) (2.5, corrected)."""
    return np.array(list(equations.euler_rate_matrix(equations.vector(np.asarray(euler, float)))))


def body_rate_matrix(euler: np.ndarray) -> np.ndarray:
    """Returns J⁻¹ of ω = J⁻¹ [φ̇ θ̇ ψ̇]ᵀ, shape (3, 3) (2.3, 2.4).

    Misprint: 2.3 lacks both transposes. With them, ω along the body axes is
    (φ̇, 0, 0) + Rx(φ)ᵀ (0, θ̇, 0) + Rx(φ)ᵀ Ry(θ)ᵀ (0, 0, ψ̇).
    """
    roll, pitch, _ = euler
    Rx, Ry = rotation(np.array([roll, 0, 0])), rotation(np.array([0, pitch, 0]))
    x, y, z = np.eye(3)
    return np.column_stack([x, Rx.T @ y, Rx.T @ Ry.T @ z])


def geometric(p: np.ndarray, R_AB: np.ndarray, geometry: Geometry) -> CablePose:
    """Returns lengths, directions and angles of the cables (2.6 - 2.10).

    Args:
        p: position of P in O, shape (3,) [m].
        R_AB: rotation of the platform, shape (3, 3).
        geometry: exit points and connectors.
    """
    b = geometry.B @ R_AB.T
    ds = p + b - geometry.A
    d = np.linalg.norm(ds, axis=1)
    s = ds / d[:, None]
    φ, θ = np.arctan2(s[:, 1], s[:, 0]), np.arctan2(np.hypot(s[:, 0], s[:, 1]), s[:, 2])
    cφ, sφ, cθ, sθ, zero = np.cos(φ), np.sin(φ), np.cos(θ), np.sin(θ), np.zeros_like(φ)
    R_Ai = np.array([[cφ * cθ, -sφ, cφ * sθ], [sφ * cθ, cφ, sφ * sθ], [-sθ, zero, cθ]])
    return CablePose(b, d, s, np.column_stack([φ, θ]), R_Ai.transpose(2, 0, 1))


def velocity(pose: CablePose, v_p: np.ndarray, ω_p: np.ndarray) -> CableMotion:
    """Returns the velocity of the connectors, ḋ and the cables' rates (2.11 - 2.16).

    Args:
        pose: from `geometric`.
        v_p: velocity of P, along O, shape (3,) [m/s].
        ω_p: rate of the platform, along O, shape (3,) [rad/s].
    """
    v_b = v_p + np.cross(ω_p, pose.arms)
    vx, vy, vz = _in_cable_frame(pose, v_b)
    ω = np.column_stack([-vy, vx, np.zeros_like(vx)]) / pose.lengths[:, None]
    return CableMotion(v_b, vz, ω)


def acceleration(
    pose: CablePose,
    motion: CableMotion,
    v_p_rate: np.ndarray,
    ω_p: np.ndarray,
    ω_p_rate: np.ndarray,
) -> CableMotion:
    """Returns acceleration of connectors, d̈ and the cables' angular accelerations (2.17 - 2.22).

    Args:
        pose: from `geometric`.
        motion: from `velocity`.
        v_p_rate: v̇_p, acceleration of P, along O, shape (3,) [m/s^2].
        ω_p: rate of the platform, along O, shape (3,) [rad/s].
        ω_p_rate: ω̇_p, angular acceleration of the platform, along O, shape (3,) [rad/s^2].
    """
    b, d = pose.arms, pose.lengths
    v_b_rate = v_p_rate + np.cross(ω_p_rate, b) + np.cross(ω_p, np.cross(ω_p, b))
    ax, ay, az = _in_cable_frame(pose, v_b_rate)
    vx, vy, d_rate = _in_cable_frame(pose, motion.connectors)
    d_rate_rate = az + (vx**2 + vy**2) / d
    s_cross_a = np.column_stack([-ay, ax, np.zeros_like(ax)])
    turns = (s_cross_a - 2 * d_rate[:, None] * motion.turns) / d[:, None]
    return CableMotion(v_b_rate, d_rate_rate, turns)


def _in_cable_frame(pose: CablePose, a: np.ndarray) -> np.ndarray:
    """Returns R_Aiᵀ a_i as rows x, y, z, shape (3, 8)."""
    return np.einsum("nki,nk->in", pose.frames, a)
