"""Backlash: a gap of ±h between rotor and drum.

A cable pulls and never pushes, and the drum weighs nothing beside the rotor: it rests at that edge
of the gap to which the cable pulls it, h behind the rotor, or floats in the gap without load.
The cable is R h longer than the rotor's angle says:

    T = λ (ε - R h/d)        zero, inside the gap, when that is negative

From a start in the middle of the gap the tension falls at once. A robot that has settled hides
its backlash as long as every cable stays taut.
"""

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def tension(s, p):  # type: ignore[no-untyped-def]
    """ΔT = -λ R h/d [N]."""
    return -s.lambda_ * s.R * p[0] / s.d


BACKLASH = DriveEffect(
    Effect(
        "backlash",
        "dead zone of ±h between rotor and drum, the drum at the edge to which its cable pulls",
        (Size("h", "rad", 0.1, 2e-3, sign=1, about="half the gap"),),
        places=DRIVES_EACH,
        phrase="roller: backlash",
        reference="Nordin, Gutman 2002",
    ),
    tension=tension,
)
