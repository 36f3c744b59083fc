"""Forces on a joint that are in no catalogue, so that no name is right.

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
from joint_worlds.compiled import compiled

BUMP, BUMP_PLACE, BUMP_WIDTH = at.BUMP, at.BUMP_PLACE, at.BUMP_WIDTH
STOP, STOP_PLACE, FAST, FAST_SPEED = at.STOP, at.STOP_PLACE, at.FAST, at.FAST_SPEED
BESIDE, BESIDE_WAVES, BESIDE_PHASE = at.BESIDE, at.BESIDE_WAVES, at.BESIDE_PHASE
DRAG, RIPPLE, RIPPLE_WAVES = at.DRAG, at.RIPPLE, at.RIPPLE_WAVES


@compiled
def unlisted(joint, q, v, q_beside, v_beside):  # type: ignore[no-untyped-def]
    """All of them on a joint."""
    f = -joint[DRAG] * v_beside
    if joint[BUMP] != 0.0:
        f += joint[BUMP] * np.exp(-(((q - joint[BUMP_PLACE]) / joint[BUMP_WIDTH]) ** 2))
    if joint[STOP] != 0.0:
        f -= joint[STOP] * np.sign(q) * max(0.0, abs(q) - joint[STOP_PLACE])
    if joint[FAST] != 0.0:
        f -= joint[FAST] * np.sign(v) * max(0.0, abs(v) - joint[FAST_SPEED])
    if joint[BESIDE] != 0.0:
        f += joint[BESIDE] * np.sin(joint[BESIDE_WAVES] * q_beside + joint[BESIDE_PHASE])
    if joint[RIPPLE] != 0.0:
        f -= joint[RIPPLE] * (1 + np.cos(joint[RIPPLE_WAVES] * q)) * v
    return f
