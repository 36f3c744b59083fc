"""The right-hand side ẋ = f(x, u) of the INCA 6D, thesis chapter 2, by its letters.

Positive angle and positive current wind the cable in. Per cable i, with A_i in the fixed frame
O, ᴮb_i in the platform frame, s_i from A_i to B_i, and R_AB the platform's rotation:

    R_AB = Rz(ψ) Ry(θ) Rx(φ)                                                          (2.1)
    [φ̇ θ̇ ψ̇]ᵀ = [[1, sφ tθ, cφ tθ], [0, cφ, −sφ], [0, sφ/cθ, cφ/cθ]] ω                 (2.5)
    d s = p + R_AB ᴮb − a                                                       (2.7, 2.8)
    ḋ = sᴮᵀ (v + ω × ᴮb),  sᴮ = R_ABᵀ s                                              (2.15)
    ε = (d − d₀)/d₀                                                                  (2.25)
    ḋ₀ = −R ω_m d₀/d                                                                 (2.30)
    T = max(0, λ ε + b (ḋ − ḋ₀))                                               (2.31, 2.32)
    ṗ = R_AB v
    m v̇ = −Σ T sᴮ + R_ABᵀ (0, 0, −m g) + R_ABᵀ G − m ω × v                     (2.33, 2.35)
    I_P ω̇ = −Σ ᴮb × T sᴮ + ᴮb_G × R_ABᵀ G − ω × I_P ω                             (2.34, 2.36)
    F_s = max(0, (R/R_s) T(0) − k_s R_s φ_m)                                         (2.41)
    J ω̇_m = K_t i − R T + R_s F_s − b_v ω_m − b_c tanh(β ω_m)                  (2.37 - 2.40)

R, R_s, k_s, λ, b, J, b_v, b_c, β and K_t are those of drive i; the thesis has one of each for all.

Misprints of the thesis, each noted where it is coded: 2.5, 2.35, 2.36, 2.40 and 2.41. The cable
cannot push and the drum spring cannot either, hence both max(0, ·); the thesis says so only in
words.
"""

from __future__ import annotations

from math import cos, sin, sqrt, tan, tanh
from pathlib import Path

import numpy as np

from identification.runtime.kept_code import kept_code
from inca_mj.reference import layout as at

FOLDERS = ("reference", "robot", "studies/worlds")  # from which the equations import

compiled = kept_code(*(Path(__file__).parents[1] / name for name in FOLDERS))


Vector = tuple[float, float, float]


@compiled
def dot(a: Vector, b: Vector) -> float:
    """Returns the scalar product aᵀb."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def cross(a: Vector, b: Vector) -> Vector:
    """Returns the vector product a × b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@compiled
def vector(a: np.ndarray) -> Vector:
    """Returns three numbers of an array, as a vector that costs no memory."""
    return (a[0], a[1], a[2])


@compiled
def times(M: tuple[Vector, Vector, Vector], a: Vector) -> Vector:
    """Returns the product M a."""
    return (dot(M[0], a), dot(M[1], a), dot(M[2], a))


@compiled
def transposed(M: tuple[Vector, Vector, Vector]) -> tuple[Vector, Vector, Vector]:
    """Returns Mᵀ."""
    return (
        (M[0][0], M[1][0], M[2][0]),
        (M[0][1], M[1][1], M[2][1]),
        (M[0][2], M[1][2], M[2][2]),
    )


@compiled
def rotation(euler: Vector) -> tuple[Vector, Vector, Vector]:
    """Returns R_AB = Rz(ψ) Ry(θ) Rx(φ), from platform axes to O (2.1); euler = (φ, θ, ψ) [rad]."""
    cr, cp, cy = cos(euler[0]), cos(euler[1]), cos(euler[2])
    sr, sp, sy = sin(euler[0]), sin(euler[1]), sin(euler[2])
    return (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )


@compiled
def euler_rate_matrix(euler: Vector) -> tuple[Vector, Vector, Vector]:
    """Returns the matrix of (2.5), [φ̇ θ̇ ψ̇]ᵀ = J ω; singular at pitch θ = ±90°.

    Misprint: the thesis prints sin φ for cos φ at (2, 2).
    """
    sr, cr, cp, tp = sin(euler[0]), cos(euler[0]), cos(euler[1]), tan(euler[1])
    return ((1.0, sr * tp, cr * tp), (0.0, cr, -sr), (0.0, sr / cp, cr / cp))


@compiled
def cables(x: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, ...]:
    """Returns the cables at a state x (36,), with numbers q (147,).

    These are T [N], d [m], ḋ [m/s] and ḋ₀ [m/s], each of shape (8,), and sᴮ of shape (8, 3), the
    unit vector from A_i to B_i along the body axes.
    """
    p, v, ω = vector(x[at.POSITION]), vector(x[at.VELOCITY]), vector(x[at.RATES])
    ω_m, d_0 = x[at.SPEEDS], x[at.NO_LOAD]
    A, B = q[at.EXITS], q[at.CONNECTORS]
    R_AB = rotation(vector(x[at.EULER]))
    R_BA = transposed(R_AB)

    T, d, d_rate, d_0_rate = np.empty((4, at.DRIVES))
    sB = np.empty((at.DRIVES, 3))
    for i in range(at.DRIVES):
        own, a_i, b_i = q[at.ROW * i :], vector(A[3 * i :]), vector(B[3 * i :])
        Rb = times(R_AB, b_i)
        ds = (p[0] + Rb[0] - a_i[0], p[1] + Rb[1] - a_i[1], p[2] + Rb[2] - a_i[2])
        d[i] = sqrt(dot(ds, ds))
        s = times(R_BA, (ds[0] / d[i], ds[1] / d[i], ds[2] / d[i]))
        sB[i, 0], sB[i, 1], sB[i, 2] = s
        ω_b = cross(ω, b_i)
        d_rate[i] = dot(s, (v[0] + ω_b[0], v[1] + ω_b[1], v[2] + ω_b[2]))
        d_0_rate[i] = -own[at.R] * ω_m[i] * d_0[i] / d[i]
        ε = (d[i] - d_0[i]) / d_0[i]
        T[i] = max(0.0, own[at.LAMBDA] * ε + own[at.B] * (d_rate[i] - d_0_rate[i]))
    return T, d, d_rate, d_0_rate, sB


@compiled
def spring_force(φ_m: float, T_0: float, own: np.ndarray) -> float:
    """Returns the force F_s of one drum spring [N] (2.41); own: the drive's row of q.

    Misprint: the thesis prints R_s/R; at rest R_s F_s must balance R T(0), so it is R/R_s.
    """
    R, R_s, k_s = own[at.R], own[at.R_S], own[at.K_S]
    return max(0.0, R / R_s * T_0 - k_s * R_s * φ_m)


@compiled
def derivative(x: np.ndarray, i: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Returns ẋ = f(x, i), shape (36,), in the order of `inca_mj.reference.layout`.

    The currents i (8,) [A] are positive where they wind in; q are the packed numbers, (147,).
    """
    m, I_P, g = q[at.M], vector(q[at.INERTIA]), q[at.G_EARTH]
    G, b_G = vector(q[at.FORCE]), vector(q[at.FORCE_AT])
    v, ω, euler = vector(x[at.VELOCITY]), vector(x[at.RATES]), vector(x[at.EULER])
    φ_m, ω_m, T_0 = x[at.ANGLES], x[at.SPEEDS], q[at.PRETENSION]
    R_AB = rotation(euler)
    R_BA = transposed(R_AB)
    T, _, _, d_0_rate, sB = cables(x, q)

    # Misprints: 2.35 and 2.36 sum from 0, leave gravity in O axes, and let G act with −T s
    # at every connector; cables pull (−T s) on the platform and G acts once, at b_G.
    GB, weight = times(R_BA, G), times(R_BA, (0.0, 0.0, -m * g))
    F = (weight[0] + GB[0], weight[1] + GB[1], weight[2] + GB[2])
    M = cross(b_G, GB)
    for k in range(at.DRIVES):
        pull = (-T[k] * sB[k, 0], -T[k] * sB[k, 1], -T[k] * sB[k, 2])
        turn = cross(vector(q[at.CONNECTORS][3 * k :]), pull)
        F = (F[0] + pull[0], F[1] + pull[1], F[2] + pull[2])
        M = (M[0] + turn[0], M[1] + turn[1], M[2] + turn[2])
    ω_v = cross(ω, v)
    ω_Iω = cross(ω, (I_P[0] * ω[0], I_P[1] * ω[1], I_P[2] * ω[2]))

    rate = np.empty(at.STATES)
    rate[0], rate[1], rate[2] = times(R_AB, v)
    rate[6], rate[7], rate[8] = times(euler_rate_matrix(euler), ω)
    for k in range(3):
        rate[3 + k] = F[k] / m - ω_v[k]
        rate[9 + k] = (M[k] - ω_Iω[k]) / I_P[k]
    for k in range(at.DRIVES):
        own = q[at.ROW * k :]
        # Misprint: 2.40 prints T R − F_s R_s; where positive winds in, the cable brakes.
        Γ = own[at.K_T] * i[k] - own[at.R] * T[k]
        Γ += own[at.R_S] * spring_force(φ_m[k], T_0[k], own)
        friction = own[at.B_V] * ω_m[k] + own[at.B_C] * tanh(own[at.BETA] * ω_m[k])
        rate[12 + k] = ω_m[k]
        rate[20 + k] = (Γ - friction) / own[at.J]
        rate[28 + k] = d_0_rate[k]
    return rate
