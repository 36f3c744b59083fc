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

    -d v - d_a |v| - e v |v| - d_p sgn(v) |v|^p - k_3 q³ + f_0 + a cos nq + b sin nq
"""

from __future__ import annotations

import numpy as np

from joint_worlds import slots as at
from joint_worlds.compiled import compiled

COULOMB, UNEVEN, PEAK, PEAK_SPEED = at.COULOMB, at.UNEVEN, at.PEAK, at.PEAK_SPEED
PEAK_POWER, LOAD = at.PEAK_POWER, at.LOAD
GRIP_COS, GRIP_SIN, GRIP_WAVES = at.GRIP_COS, at.GRIP_SIN, at.GRIP_WAVES
STIFF, DAMP, VISCOUS, UNEVEN_VISCOUS = at.STIFF, at.DAMP, at.VISCOUS, at.UNEVEN_VISCOUS
GIVE = at.GIVE
SQUARE, ROOT, ROOT_POWER, CUBE, PUSH = at.SQUARE, at.ROOT, at.ROOT_POWER, at.CUBE, at.PUSH
COG_COS, COG_SIN, COG_WAVES = at.COG_COS, at.COG_SIN, at.COG_WAVES


@compiled
def largest(joint, q, v, tau, g, side):  # type: ignore[no-untyped-def]
    """Friction of a joint, at most, in the direction `side` (1 forward, -1 backward)."""
    b = joint[COULOMB] + side * joint[UNEVEN]
    if joint[PEAK] != 0.0:
        b += joint[PEAK] * np.exp(-((abs(v) / joint[PEAK_SPEED]) ** joint[PEAK_POWER]))
    b += joint[LOAD] * abs(tau + g)
    if joint[GRIP_COS] != 0.0 or joint[GRIP_SIN] != 0.0:
        angle = joint[GRIP_WAVES] * q
        b += joint[GRIP_COS] * np.cos(angle) + joint[GRIP_SIN] * np.sin(angle)
    return max(0.0, b)


@compiled
def stretched(joint, z, low, high):  # type: ignore[no-untyped-def]
    """The spring of the contact after it has slipped."""
    return min(max(z, -low / joint[STIFF]), high / joint[STIFF])


@compiled
def dahl(joint, z, x, low, high):  # type: ignore[no-untyped-def]
    """Dahl's friction after a way x from a stretch z."""
    p, end = z / joint[GIVE], high if x > 0.0 else -low
    if end == 0.0:
        return 0.0
    return end + (p - end) * np.exp(-abs(x) / (joint[GIVE] * abs(end)))


@compiled
def held(joint, z, v, low, high):  # type: ignore[no-untyped-def]
    """What friction resists with."""
    f = joint[STIFF] * stretched(joint, z, low, high) + joint[DAMP] * v
    return min(max(f, -low), high)


@compiled
def force(joint, q, v):  # type: ignore[no-untyped-def]
    """All other forces on a joint."""
    speed = abs(v)
    f = -joint[VISCOUS] * v - joint[UNEVEN_VISCOUS] * speed - joint[SQUARE] * v * speed
    if joint[ROOT] != 0.0:
        f -= joint[ROOT] * np.sign(v) * speed ** joint[ROOT_POWER]
    f += joint[PUSH] - joint[CUBE] * q**3
    if joint[COG_COS] != 0.0 or joint[COG_SIN] != 0.0:
        angle = joint[COG_WAVES] * q
        f += joint[COG_COS] * np.cos(angle) + joint[COG_SIN] * np.sin(angle)
    return f
