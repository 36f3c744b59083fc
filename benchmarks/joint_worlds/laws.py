"""What acts on a joint: friction that holds, and forces.

Friction is a stiff spring k and damper c between joint and frame that slips (Prandtl 1928). Over a
step that begins at q_0 with a spring that is stretched by z_0,

    ẑ = min(max(z_0 + q - q_0, -b⁻/k), b⁺/k)              f = min(max(k ẑ + c v, -b⁻), b⁺)

resists the motion with f, and the step ends with z = ẑ. Below b± the joint comes to rest and stays
there; there is no creep, and no sign of the velocity. The largest frictions by direction are

    b± = max(0, f_c ± f_a + f_s exp(-(|v|/v_s)^p) + μ |τ + g| + a cos nq + b sin nq)

with the drive's force τ and what gravity asks for, g (M q̈ + c + g = τ): the two ends of the gears
are loaded with τ and -g.
Where friction gives (GIVE, c), its contact is Dahl's instead: z = c p, and over a way x, of which s
is the sign and b that of its direction,

    p = s b + (p_0 - s b) exp(-|x|/(c b))              f = p

Other forces on the joint:

    -d v - d_a |v| - e v |v| - d_p sgn(v) |v|^p - k_3 q³ + f_0 + a cos nq + b sin nq + α g

Forces that are in no catalogue, so that no name is right:

    bump        a exp(-((q - q_b)/w)²)                     a place where a cable or a seal catches
    stop        -k sgn(q) max(0, |q| - q_s)                a soft stop near the ends of the travel
    fast        -d sgn(v) max(0, |v| - v_f)                a brake that acts from a speed on
    beside      a sin(n q_o + φ)                           a hose that a neighbouring joint moves
    drag        -d v_o                                     a belt that a neighbouring joint moves
    ripple      -d (1 + cos n q) v                         viscous friction that waves along the way

The neighbour of a joint, q_o and v_o, is the joint before it, and that of the first the second.
"""

from __future__ import annotations

import numpy as np

from joint_worlds import slots as at
from joint_worlds.slots import compiled


@compiled
def largest(joint, q, v, tau, g, side):  # type: ignore[no-untyped-def]
    """Friction of a joint, at most, in the direction `side` (1 forward, -1 backward)."""
    b = joint[at.COULOMB] + side * joint[at.UNEVEN]
    if joint[at.PEAK] != 0.0:
        b += joint[at.PEAK] * np.exp(-((abs(v) / joint[at.PEAK_SPEED]) ** joint[at.PEAK_POWER]))
    b += joint[at.LOAD] * abs(tau + g)
    if joint[at.GRIP_COS] != 0.0 or joint[at.GRIP_SIN] != 0.0:
        angle = joint[at.GRIP_WAVES] * q
        b += joint[at.GRIP_COS] * np.cos(angle) + joint[at.GRIP_SIN] * np.sin(angle)
    return max(0.0, b)


@compiled
def stretched(joint, z, low, high):  # type: ignore[no-untyped-def]
    """The spring of the contact after it has slipped."""
    return min(max(z, -low / joint[at.STIFF]), high / joint[at.STIFF])


@compiled
def dahl(joint, z, x, low, high):  # type: ignore[no-untyped-def]
    """Dahl's friction after a way x from a stretch z."""
    p, end = z / joint[at.GIVE], high if x > 0.0 else -low
    if end == 0.0:
        return 0.0
    return end + (p - end) * np.exp(-abs(x) / (joint[at.GIVE] * abs(end)))


@compiled
def held(joint, z, v, low, high):  # type: ignore[no-untyped-def]
    """What friction resists with."""
    f = joint[at.STIFF] * stretched(joint, z, low, high) + joint[at.DAMP] * v
    return min(max(f, -low), high)


@compiled
def force(joint, q, v):  # type: ignore[no-untyped-def]
    """All other forces on a joint."""
    speed = abs(v)
    f = -joint[at.VISCOUS] * v - joint[at.UNEVEN_VISCOUS] * speed - joint[at.SQUARE] * v * speed
    if joint[at.ROOT] != 0.0:
        f -= joint[at.ROOT] * np.sign(v) * speed ** joint[at.ROOT_POWER]
    f += joint[at.PUSH] - joint[at.CUBE] * q**3
    if joint[at.COG_COS] != 0.0 or joint[at.COG_SIN] != 0.0:
        angle = joint[at.COG_WAVES] * q
        f += joint[at.COG_COS] * np.cos(angle) + joint[at.COG_SIN] * np.sin(angle)
    return f


@compiled
def unlisted(joint, q, v, q_beside, v_beside):  # type: ignore[no-untyped-def]
    """All forces in no catalogue on a joint."""
    f = -joint[at.DRAG] * v_beside
    if joint[at.BUMP] != 0.0:
        f += joint[at.BUMP] * np.exp(-(((q - joint[at.BUMP_PLACE]) / joint[at.BUMP_WIDTH]) ** 2))
    if joint[at.STOP] != 0.0:
        f -= joint[at.STOP] * np.sign(q) * max(0.0, abs(q) - joint[at.STOP_PLACE])
    if joint[at.FAST] != 0.0:
        f -= joint[at.FAST] * np.sign(v) * max(0.0, abs(v) - joint[at.FAST_SPEED])
    if joint[at.BESIDE] != 0.0:
        f += joint[at.BESIDE] * np.sin(joint[at.BESIDE_WAVES] * q_beside + joint[at.BESIDE_PHASE])
    if joint[at.RIPPLE] != 0.0:
        f -= joint[at.RIPPLE] * (1 + np.cos(joint[at.RIPPLE_WAVES] * q)) * v
    return f
