"""The laws of the joint effects: what each adds to the force on a hinge or slide joint.

Friction resists the motion ahead, whose sign is s, with at most

    b =   f_c                                   Coulomb friction
        + f_a s                                 its difference by direction: f_c + f_a forward
        + f_s exp(-|v/v_s|^n)                   Stribeck peak
        + μ |f_u|                               friction that grows with the drive's force f_u
        + μ |f_u - f_g|                         ... with the load that the gears transmit
        + μ |f_g|                               ... with gravity's force f_g alone
        + μ_s |f_u - f_g| exp(-|v/v_s|)         ... a Stribeck peak that grows with that load
        + μ |f_u - ρ f_g|                       ... with drive's force and gravity's, by shares
        + exp(-|v/v_s|) (q_e f_g² or q_m f_u²)  ... with the square of the smaller, if they oppose
        + f_q q                                 Coulomb friction that changes along the way
        + a cos n q + b sin n q                 friction that repeats along the way

and holds what drives less than that (see `identification.native.joint_friction`). Forces are

    f = - d_a |v|                               viscous friction by direction: d + d_a forward
        - c v |v|                               quadratic friction
        - d_p v |v|^(p-1)                       friction that grows less than viscous friction
        - d_q q v                               viscous friction that changes along the way
        + a cos n q + b sin n q                 cogging
        + f_0                                   constant force
        - k q                                   spring
        - k_3 q³                                its hardening
        - c f_u³                                a drive that weakens where it pushes hard

q, v: position and velocity [rad, rad/s or m, m/s]; f: torque or force [N m or N], as MuJoCo's
qfrc_passive counts it. Gears transmit |f_u - f_g|: what the drive pushes against what pulls at the
other end (Duclusaud, Passault, Padois, Ly 2024, models M3 to M6). Each function takes the joint's
state (see `identification.native.joint_callback.Joint`) and the effect's parameters, sizes first.
"""

from __future__ import annotations

from math import cos, exp, sin

from numba import njit


@njit
def coulomb_friction(s, p):  # type: ignore[no-untyped-def]
    """f_c."""
    return p[0]


@njit
def asymmetric_friction(s, p):  # type: ignore[no-untyped-def]
    """f_a s."""
    return p[0] * s.sign


@njit
def stribeck_friction(s, p):  # type: ignore[no-untyped-def]
    """f_s exp(-|v/v_s|^n)."""
    f_s, v_s, n = p
    return f_s * exp(-(abs(s.v / v_s) ** n))


@njit
def load_dependent_friction(s, p):  # type: ignore[no-untyped-def]
    """μ |f_u|."""
    return p[0] * abs(s.f_u)


@njit
def transmitted_load_friction(s, p):  # type: ignore[no-untyped-def]
    """μ |f_u - f_g|."""
    return p[0] * abs(s.f_u - s.f_g)


@njit
def gravity_load_friction(s, p):  # type: ignore[no-untyped-def]
    """μ |f_g|."""
    return p[0] * abs(s.f_g)


@njit
def load_stribeck_friction(s, p):  # type: ignore[no-untyped-def]
    """μ_s |f_u - f_g| exp(-|v/v_s|)."""
    mu_s, v_s = p
    return mu_s * abs(s.f_u - s.f_g) * exp(-abs(s.v / v_s))


@njit
def two_load_friction(s, p):  # type: ignore[no-untyped-def]
    """μ |f_u - ρ f_g|: what Duclusaud et al. write |K_m f_u - K_e f_g|, ρ = K_e/K_m."""
    mu, rho = p
    return mu * abs(s.f_u - rho * s.f_g)


@njit
def quadratic_load_friction(s, p):  # type: ignore[no-untyped-def]
    """q_e f_g² where |f_u| > |f_g|, else q_m f_u²; times exp(-|v/v_s|), where the two oppose."""
    q_e, q_m, v_s = p
    if s.f_u * s.f_g >= 0.0:
        return 0.0
    load = q_e * s.f_g * s.f_g if abs(s.f_u) > abs(s.f_g) else q_m * s.f_u * s.f_u
    return load * exp(-abs(s.v / v_s))


@njit
def position_dependent_friction(s, p):  # type: ignore[no-untyped-def]
    """f_q q."""
    return p[0] * s.q


@njit
def periodic_friction(s, p):  # type: ignore[no-untyped-def]
    """a cos n q + b sin n q."""
    a, b, n = p
    return a * cos(n * s.q) + b * sin(n * s.q)


@njit
def asymmetric_viscous_friction(s, p):  # type: ignore[no-untyped-def]
    """-d_a |v|."""
    return -p[0] * abs(s.v)


@njit
def quadratic_friction(s, p):  # type: ignore[no-untyped-def]
    """-c v |v|."""
    return -p[0] * s.v * abs(s.v)


@njit
def sublinear_friction(s, p):  # type: ignore[no-untyped-def]
    """-d_p v |v|^(n-1), n < 1."""
    d_p, n = p
    speed = abs(s.v)
    if speed == 0.0:
        return 0.0
    return -d_p * s.v * speed ** (n - 1.0)


@njit
def position_dependent_damping(s, p):  # type: ignore[no-untyped-def]
    """-d_q q v."""
    return -p[0] * s.v * s.q


@njit
def cogging(s, p):  # type: ignore[no-untyped-def]
    """a cos n q + b sin n q."""
    a, b, n = p
    return a * cos(n * s.q) + b * sin(n * s.q)


@njit
def offset(s, p):  # type: ignore[no-untyped-def]
    """f_0."""
    return p[0]


@njit
def stiffness(s, p):  # type: ignore[no-untyped-def]
    """-k q."""
    return -p[0] * s.q


@njit
def hardening(s, p):  # type: ignore[no-untyped-def]
    """-k_3 q³."""
    return -p[0] * s.q * s.q * s.q


@njit
def torque_saturation(s, p):  # type: ignore[no-untyped-def]
    """-c f_u³."""
    return -p[0] * s.f_u * s.f_u * s.f_u
