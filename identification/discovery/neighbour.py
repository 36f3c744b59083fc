"""When a law falls so far short of a curve of the data that it has a neighbour's name.

    (f_c - f)/(1 - f) > MOST_LEFT  and  (f_c - f)/f_c > FAR_FROM_EXACT
    c/(l + c) > MOST_OF_BOTH                    l, c: what law, and forces beside it, explain

f, f_c: falls of the mean square by the law, and by the curve in its place or beside it. The right
law leaves little to any curve, and what it leaves is little of what it explains.
"""

from __future__ import annotations

# Of the error that a law leaves. In hidden worlds curves that were beyond chance took 13 % or less
# beside laws that were right, and 20 % or more beside neighbours (docs/discovery.md).
MOST_LEFT = 0.2
# Of the power of both, which is a sixth of their force: no right law is as far from a robot's.
FAR_FROM_EXACT = 0.03
# Of what a law and the forces of no law beside it explain together: a judgement. In the worlds of
# docs/robot/models.md curves explained less beside 33 of 34 right laws, and more beside 2 of 8 laws
# that were not there.
MOST_OF_BOTH = 0.15
MORE_LIKELY_THAN_NOT = 0.5  # chance of a curve beside a law, above which it may be luck


def falls_short(law: float, curve: float) -> bool:
    """Returns whether a law falls far short of a curve.

    Args:
        law: fall of the mean square by it, f.
        curve: fall by the curve, f_c.
    """
    more = curve - law
    return more > MOST_LEFT * (1 - law) and more > FAR_FROM_EXACT * curve


def of_both(law: float, forces: float) -> float:
    """Returns what forces of no law explain of what a law and they explain together."""
    return forces / (law + forces) if law + forces > 0 else 0.0


def has_name_of_neighbour(of_both: float, chance: float) -> bool:
    """Returns whether a law has the name of a neighbour of what is missing.

    Args:
        of_both: what forces beside it explain of what it and they explain.
        chance: of as much by luck.
    """
    return of_both > MOST_OF_BOTH and chance < MORE_LIKELY_THAN_NOT
