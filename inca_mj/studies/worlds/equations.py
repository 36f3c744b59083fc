"""The right-hand side of a world: the reference's equations with every effect in its place.

    d, s       path of the cable from the true, moving A_i                       `path`
    R_k        = R (1 + δ + a cos ψ + b sin ψ) + h ψ
    ḋ₀         = −R_k ψ̇ d₀/d,  ψ̇ = ω_m, or 0 inside the play
    T          = max(0, λ ε (1 + κ ε^n) + c λ (ε − ε_v) + b (ḋ − ḋ₀) + sag)
    J ω̇_m      = K_t (1 + δ)(1 − D) i_m + torques − R_k T + R_s F_s − friction
    m v̇        = reference + weight of the cables − R_ABᵀ c |v|^(n−1) v

R, R_s, K_t and the other numbers of a drive are its own: `own` is its row of the packed numbers, in
which one may change as time goes by.

Each function is one of these lines and none of them is the reference's, so that a test may ask
the two to agree where no effect is on. An effect that is off is skipped or adds an exact zero.
"""

from __future__ import annotations

from math import atan2, cos, exp, pi, sin, sqrt, tanh

import numpy as np

from inca_mj.reference import layout as base
from inca_mj.reference.equations import (
    Vector,
    compiled,
    cross,
    dot,
    euler_rate_matrix,
    rotation,
    times,
    transposed,
    vector,
)
from inca_mj.studies.worlds import layout as at


@compiled
def path(ds: Vector, r: float, side: float) -> tuple[float, Vector]:
    """Returns the length of the path [m], and its gradient by the connector, a unit vector in O.

    A pulley of radius r swivels about the vertical through A, where the cable enters it along that
    vertical; the pulley stands in the vertical plane of A and the connector, its centre at r u,
    with u horizontal towards the connector. In that plane, from A: ρ along u, z along the vertical
    (upwards for an exit point that is high, downwards for a low one: the cable runs over the side
    away from the platform), the cable leaves the pulley where the normal has the angle α:

        w = (ρ − r, z),  l = √(|w|² − r²)                        tangent from the pulley to B
        α = atan2(z, ρ − r) + atan2(l, r)                        w = r n(α) + l t(α)
        d = r (π − α) + l,  ∂d/∂B = t = (sin α, −cos α)          arc and tangent

    `ds` leads from A to the connector, in O [m]. r = 0 is a straight cable. `side` is +1 for a
    cable over the top of its pulley, −1 for one under it.
    """
    if r == 0.0:
        d = sqrt(ds[0] * ds[0] + ds[1] * ds[1] + ds[2] * ds[2])
        return d, (ds[0] / d, ds[1] / d, ds[2] / d)
    ρ = sqrt(ds[0] * ds[0] + ds[1] * ds[1])
    wx, wz = ρ - r, side * ds[2]
    square = wx * wx + wz * wz - r * r
    l = sqrt(square) if square > 0.0 else np.nan  # the connector is inside the pulley
    α = atan2(wz, wx) + atan2(l, r)
    tx, tz = sin(α), -cos(α)
    return r * (pi - α) + l, (tx * ds[0] / ρ, tx * ds[1] / ρ, side * tz)


EDGE = 1e-9  # a rotor this near to an edge of its gap pushes it: rounding must not let go [rad]


@compiled
def changed(t: float, heat: float, own: np.ndarray, D: np.ndarray) -> np.ndarray:
    """Returns the numbers of a drive at a time, of which one may drift or jump."""
    which = int(D[at.CHANGED]) - 1
    if which < 0:
        return own
    now = own.copy()
    c = -D[at.CHANGE_RATE] * t - D[at.CHANGE_HEAT] * heat
    if t >= D[at.JUMP_TIME] - 1e-9:
        c += D[at.JUMP]
    now[which] *= 1.0 + c
    return now


@compiled
def radius(ψ: float, R: float, D: np.ndarray) -> float:
    """Returns R_k at the drum angle ψ [m]; D: the drive's row."""
    change = D[at.RADIUS_ERROR] + D[at.ECC_COS] * cos(ψ) + D[at.ECC_SIN] * sin(ψ)
    return R * (1.0 + change) + D[at.LAYER] * ψ


@compiled
def drum_rate(φ: float, ψ: float, ω: float, h: float) -> float:
    """Returns ψ̇ of the play operator: ω where the rotor pushes the gap's edge, else 0 [rad/s]."""
    edge = h - EDGE
    if h == 0.0 or (φ - ψ >= edge and ω > 0.0) or (φ - ψ <= -edge and ω < 0.0):
        return ω
    return 0.0


@compiled
def elastic(ε: float, ε_v: float, λ: float, D: np.ndarray) -> float:
    """Returns the tension of a cable's springs [N]: λ ε (1 + κ ε^n) + c λ (ε − ε_v)."""
    T = λ * ε
    if D[at.CABLE_HARD] != 0.0:
        T += λ * ε * D[at.CABLE_HARD] * abs(ε) ** D[at.CABLE_POWER]
    if D[at.MAXWELL] != 0.0:
        T += D[at.MAXWELL] * λ * (ε - ε_v)
    return T


@compiled
def sagging(T: float, K: float) -> float:
    """Returns the root of T' = T + K/T'² [N], K [N^3]: a hanging cable is never quite slack."""
    root = max(0.0, T) + K ** (1.0 / 3.0)
    if T < 0.0:
        root = min(root, sqrt(-K / T))
    for _ in range(10):  # concave and rising: Newton comes from below after its first step
        slope = 1.0 + 2.0 * K / root**3
        root = max(root - (root - T - K / root**2) / slope, 0.1 * root)
    return root


@compiled
def tension(d: float, d_0: float, stretch: float, ε_v: float, span: float, g: float,
            own: np.ndarray, D: np.ndarray) -> float:  # fmt: skip
    """Returns T of one cable [N]; stretch: ḋ − ḋ₀ [m/s], span: horizontal [m]."""
    λ, b = own[base.LAMBDA], own[base.B]
    T = elastic((d - d_0) / d_0, ε_v, λ, D) + b * stretch
    if D[at.SAG] != 0.0 and D[at.LINE_WEIGHT] > 0.0:
        w = D[at.LINE_WEIGHT] * g * span
        return sagging(T, λ * d / d_0 * w * w / 24.0)
    return max(0.0, T)


@compiled
def friction(ω: float, φ: float, RT: float, own: np.ndarray, D: np.ndarray) -> float:
    """Returns the torque that brakes a rotor [N m]; RT: load of the cable [N m]."""
    b_v, b_c, β = own[base.B_V], own[base.B_C], own[base.BETA]
    σ = tanh(β * ω)
    level = b_c * (1.0 + D[at.COULOMB_ERROR]) + D[at.LOAD] * RT
    if D[at.ANGLE_COS] != 0.0 or D[at.ANGLE_SIN] != 0.0:
        level += b_c * (D[at.ANGLE_COS] * cos(φ) + D[at.ANGLE_SIN] * sin(φ))
    if D[at.STRIBECK] != 0.0:
        n = D[at.STRIBECK_POWER]
        level += D[at.STRIBECK] * exp(-((abs(ω) / D[at.STRIBECK_SPEED]) ** n))
    τ = b_v * ω + level * σ + D[at.ASYMMETRY] * abs(σ)
    if D[at.QUADRATIC] != 0.0:
        τ += D[at.QUADRATIC] * ω * abs(ω) ** (D[at.QUADRATIC_POWER] - 1.0)
    return τ


@compiled
def spring(φ: float, ω: float, RT_0: float, own: np.ndarray, D: np.ndarray) -> float:
    """Returns F_s of one drum spring [N]; RT_0: the load that it balances at φ = 0 [N m]."""
    R_s, k_s, β = own[base.R_S], own[base.K_S], own[base.BETA]
    s = R_s * φ
    F = RT_0 / R_s - k_s * s
    if D[at.SPRING_HARD] != 0.0:
        F -= k_s * s * D[at.SPRING_HARD] * abs(s) ** D[at.SPRING_POWER]
    return max(0.0, F) * (1.0 + D[at.SPRING_LOSS] * tanh(β * ω))


@compiled
def motor(t: float, i: float, heat: float, φ: float, own: np.ndarray, D: np.ndarray) -> float:
    """Returns the torque of a motor [N m]."""
    loss = D[at.HEAT_LOSS] * heat
    if D[at.DRIFT_TIME] > 0.0:
        loss += D[at.DRIFT] * D[at.DRIFT_TIME] * (1.0 - exp(-t / D[at.DRIFT_TIME]))
    else:
        loss += D[at.DRIFT] * t
    Γ = own[base.K_T] * (1.0 + D[at.GAIN_ERROR]) * (1.0 - loss) * i
    if D[at.COG_N] != 0.0:
        Γ += D[at.COG_COS] * cos(D[at.COG_N] * φ) + D[at.COG_SIN] * sin(D[at.COG_N] * φ)
    if D[at.RIPPLE] != 0.0:
        Γ += D[at.RIPPLE] * sin(D[at.RIPPLE_RATE] * t + D[at.RIPPLE_PHASE])
    return Γ


@compiled
def shake(t: float, D: np.ndarray) -> tuple[Vector, Vector]:
    """Returns the offset [m] and velocity [m/s] of an exit point in O."""
    w, a = D[at.SHAKE_RATE], vector(D[at.SHAKE_X :])
    if w == 0.0:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    s, c = sin(w * t + D[at.SHAKE_PHASE]), w * cos(w * t + D[at.SHAKE_PHASE])
    return (s * a[0], s * a[1], s * a[2]), (c * a[0], c * a[1], c * a[2])


@compiled
def drag(v: Vector, P: np.ndarray) -> Vector:
    """Returns the force of the air along the body axes [N]; v: velocity along them [m/s]."""
    speed = sqrt(dot(v, v))
    if P[at.DRAG] == 0.0 or speed == 0.0:
        return (0.0, 0.0, 0.0)
    k = -P[at.DRAG] * speed ** (P[at.DRAG_POWER] - 1.0)
    return (k * v[0], k * v[1], k * v[2])


@compiled
def world_rate(t: float, x: np.ndarray, i: np.ndarray, q: np.ndarray, D: np.ndarray,
               P: np.ndarray, rate: np.ndarray) -> None:  # fmt: skip
    """Fill ẋ of the 60 states x at t [s], under currents i (8,) [A] that flow.

    q (147,), D (8, 49) and P (3,) are the numbers of a `HiddenPlant`.
    """
    m, g, I_P = q[base.M], q[base.G_EARTH], vector(q[base.INERTIA])
    G, b_G = vector(q[base.FORCE]), vector(q[base.FORCE_AT])
    A, B, T_0 = q[base.EXITS], q[base.CONNECTORS], q[base.PRETENSION]
    p, v, euler, ω = vector(x), vector(x[3:]), vector(x[6:]), vector(x[9:])
    R_AB = rotation(euler)
    R_BA = transposed(R_AB)
    down = times(R_BA, (0.0, 0.0, -g))  # gravity along the body axes
    GB = times(R_BA, G)
    air = drag(v, P)
    F = (m * down[0] + GB[0] + air[0], m * down[1] + GB[1] + air[1], m * down[2] + GB[2] + air[2])
    M = cross(b_G, GB)
    for k in range(base.DRIVES):
        D_k = D[k]
        own = changed(t, x[52 + k], q[base.ROW * k :], D_k)
        a, b_k = vector(A[3 * k :]), vector(B[3 * k :])
        φ, ω_m, d_0, R = x[12 + k], x[20 + k], x[28 + k], own[base.R]
        ψ, ε_v, heat = (φ if D_k[at.PLAY] == 0.0 else x[36 + k]), x[44 + k], x[52 + k]

        moved, moving = shake(t, D_k)
        Rb = times(R_AB, b_k)
        ds = (p[0] + Rb[0] - a[0] - moved[0], p[1] + Rb[1] - a[1] - moved[1],
              p[2] + Rb[2] - a[2] - moved[2])  # fmt: skip
        d, s = path(ds, D_k[at.PULLEY], D_k[at.PULLEY_SIDE])
        sB, ω_b = times(R_BA, s), cross(ω, b_k)
        d_rate = dot(sB, (v[0] + ω_b[0], v[1] + ω_b[1], v[2] + ω_b[2])) - dot(s, moving)

        R_k, ω_d = radius(ψ, R, D_k), drum_rate(φ, ψ, ω_m, D_k[at.PLAY])
        d_0_rate = -R_k * ω_d * d_0 / d
        span = sqrt(ds[0] * ds[0] + ds[1] * ds[1])
        T = tension(d, d_0, d_rate - d_0_rate, ε_v, span, g, own, D_k)

        hangs = 0.5 * D_k[at.LINE_WEIGHT] * d
        pull = (hangs * down[0] - T * sB[0], hangs * down[1] - T * sB[1],
                hangs * down[2] - T * sB[2])  # fmt: skip
        turn = cross(b_k, pull)
        F = (F[0] + pull[0], F[1] + pull[1], F[2] + pull[2])
        M = (M[0] + turn[0], M[1] + turn[1], M[2] + turn[2])

        Γ = motor(t, i[k], heat, φ, own, D_k) - R_k * T
        Γ += own[base.R_S] * spring(φ, ω_m, radius(0.0, R, D_k) * T_0[k], own, D_k)
        rate[12 + k] = ω_m
        rate[20 + k] = (Γ - friction(ω_m, φ, R_k * T, own, D_k)) / own[base.J]
        rate[28 + k] = d_0_rate
        rate[36 + k] = ω_d
        ε = (d - d_0) / d_0
        rate[44 + k] = (ε - ε_v) / D_k[at.MAXWELL_TIME] if D_k[at.MAXWELL] != 0.0 else 0.0
        rate[52 + k] = i[k] * i[k]
    ω_v = cross(ω, v)
    ω_Iω = cross(ω, (I_P[0] * ω[0], I_P[1] * ω[1], I_P[2] * ω[2]))
    rate[0], rate[1], rate[2] = times(R_AB, v)
    rate[6], rate[7], rate[8] = times(euler_rate_matrix(euler), ω)
    for k in range(3):
        rate[3 + k] = F[k] / m - ω_v[k]
        rate[9 + k] = (M[k] - ω_Iω[k]) / I_P[k]
