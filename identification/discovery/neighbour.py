"""When a law falls so far short of a curve of the data that it has a neighbour's name.

    (f_c - f)/(1 - f) > MOST_LEFT  and  (f_c - f)/f_c > FAR_FROM_EXACT

f, f_c: falls of the mean square by the law, and by the curve in its place or beside it. The right
law leaves little to any curve, and what it leaves is little of what it explains.
"""

from __future__ import annotations

# Of the error that a law leaves. In hidden worlds curves that were beyond chance took 13 % or less
# beside laws that were right, and 20 % or more beside neighbours (docs/discovery.md).
MOST_LEFT = 0.2
# Of the power of both, which is a sixth of their force: no right law is as far from a robot's.
FAR_FROM_EXACT = 0.03
MORE_LIKELY_THAN_NOT = 0.5  # chance of a curve beside a law, above which it may be luck


def falls_short(law: float, curve: float) -> bool:
    """Returns whether a law falls far short of a curve.

    Args:
        law: fall of the mean square by it, f.
        curve: fall by the curve, f_c.
    """
    more = curve - law
    return more > MOST_LEFT * (1 - law) and more > FAR_FROM_EXACT * curve
