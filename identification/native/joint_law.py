"""The force of all joint effects together, on one hinge or slide joint.

    s = tanh(v/v₀)                              a sign that a fixed step can integrate

    f = - f_c s                                 Coulomb friction
        - f_a |s|                               its difference by direction: f_c + f_a forward
        - d_a |v|                               viscous friction by direction: d + d_a forward
        - f_s exp(-(v/v_s)²) s                  Stribeck peak
        - c v |v|                               quadratic friction
        - μ |f_u| s                             friction that grows with the drive's force f_u
        - (f_q s + d_q v) q                     friction along the way
        - (a_f cos n_f q + b_f sin n_f q) s     friction that repeats along the way
        + a cos n q + b sin n q                 cogging
        + f_0 - k q - k_3 q³                    offset, stiffness, its hardening

q, v: position and velocity [rad, rad/s or m, m/s]; f: torque or force [N m or N], as MuJoCo's
qfrc_passive counts it. v₀ is fixed for each joint, `Axis.smooth`, 1 % of its top speed: friction
below it creeps instead of sticking.
"""

from __future__ import annotations

from collections import namedtuple
from math import cos, exp, sin, tanh
from typing import Any

from numba import njit

# The letters above, in the order of a joint's user data behind its key.
Numbers: Any = namedtuple(
    "Numbers", "v_0 f_c f_a d_a f_s v_s c mu f_q d_q a_f b_f n_f a b n f_0 k k_3"
)


@njit(error_model="numpy")
def force(q, v, f_u, p):  # type: ignore[no-untyped-def]
    """Force of the effects on a joint [N or N m].

    Args:
        q: position [m or rad].
        v: velocity [m/s or rad/s].
        f_u: force of its drives [N or N m].
        p: the joint's `Numbers`; zero what it has not.
    """
    s = tanh(v / p.v_0)
    f = p.f_0 - p.k * q - p.f_c * s - p.f_a * abs(s) - p.d_a * abs(v) - p.c * v * abs(v)
    f -= p.mu * abs(f_u) * s + (p.f_q * s + p.d_q * v) * q
    f -= p.k_3 * q * q * q
    if p.f_s != 0.0:
        f -= p.f_s * exp(-((v / p.v_s) ** 2)) * s
    if p.a_f != 0.0 or p.b_f != 0.0:
        f -= (p.a_f * cos(p.n_f * q) + p.b_f * sin(p.n_f * q)) * s
    if p.a != 0.0 or p.b != 0.0:
        f += p.a * cos(p.n * q) + p.b * sin(p.n * q)
    return f
