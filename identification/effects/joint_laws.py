"""The laws of the joint effects: what each adds to the force on a hinge or slide joint.

    s = tanh(v/v₀)                              a sign that a fixed step can integrate

    f = - f_c s                                 Coulomb friction
        - f_a |s|                               its difference by direction: f_c + f_a forward
        - d_a |v|                               viscous friction by direction: d + d_a forward
        - f_s exp(-(v/v_s)²) s                  Stribeck peak
        - c v |v|                               quadratic friction
        - μ |f_u| s                             friction that grows with the drive's force f_u
        - f_q q s                               Coulomb friction that changes along the way
        - d_q q v                               viscous friction that changes along the way
        - (a cos n q + b sin n q) s             friction that repeats along the way
        + a cos n q + b sin n q                 cogging
        + f_0                                   constant force
        - k q                                   spring
        - k_3 q³                                its hardening

q, v: position and velocity [rad, rad/s or m, m/s]; f: torque or force [N m or N], as MuJoCo's
qfrc_passive counts it. v₀ is fixed for each joint, `Axis.smooth`, 1 % of its top speed: friction
below it creeps instead of sticking. Each function takes the joint's state (see
`identification.native.joint_callback.Joint`) and the effect's parameters, sizes first.
"""

from __future__ import annotations

from math import cos, exp, sin

from numba import njit


@njit
def coulomb_friction(s, p):  # type: ignore[no-untyped-def]
    """-f_c s."""
    return -p[0] * s.sign


@njit
def asymmetric_friction(s, p):  # type: ignore[no-untyped-def]
    """-f_a |s|."""
    return -p[0] * abs(s.sign)


@njit
def asymmetric_viscous_friction(s, p):  # type: ignore[no-untyped-def]
    """-d_a |v|."""
    return -p[0] * abs(s.v)


@njit
def stribeck_friction(s, p):  # type: ignore[no-untyped-def]
    """-f_s exp(-(v/v_s)²) s."""
    f_s, v_s = p
    return -f_s * exp(-((s.v / v_s) ** 2)) * s.sign


@njit
def quadratic_friction(s, p):  # type: ignore[no-untyped-def]
    """-c v |v|."""
    return -p[0] * s.v * abs(s.v)


@njit
def load_dependent_friction(s, p):  # type: ignore[no-untyped-def]
    """-μ |f_u| s."""
    return -p[0] * abs(s.f_u) * s.sign


@njit
def position_dependent_friction(s, p):  # type: ignore[no-untyped-def]
    """-f_q q s."""
    return -p[0] * s.sign * s.q


@njit
def position_dependent_damping(s, p):  # type: ignore[no-untyped-def]
    """-d_q q v."""
    return -p[0] * s.v * s.q


@njit
def periodic_friction(s, p):  # type: ignore[no-untyped-def]
    """-(a cos n q + b sin n q) s."""
    a, b, n = p
    return -(a * cos(n * s.q) + b * sin(n * s.q)) * s.sign


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
