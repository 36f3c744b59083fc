"""The period of a periodic force of a joint, and how large the force may be."""

from __future__ import annotations

from math import pi

from identification.effects.effect import Shape, Size
from identification.effects.joint_group import Group

# Of a slide's travel, to try: a wave that is off by one period of the travel is out of step with
# the true one at an end, so that none is left out up to the pitch of usual linear motors.
PERIODS = tuple(map(float, range(2, 33)))
SEEN = 2.0  # periods within the travel, below which a curve is not seen to repeat


def wave_sizes(g: Group) -> tuple[Size, ...]:
    """Returns the amplitudes of cosine and sine."""
    return (
        g.size("a", 0.2 * g.F, g.f, "amplitude of the cosine"),
        g.size("b", 0.2 * g.F, g.f, "amplitude of the sine"),
    )


def waves(g: Group) -> Shape | None:
    """Returns how often a periodic force repeats: in a turn, or in 2π m of a slide.

    A wave of which the log shows fewer than `SEEN` periods is not seen to repeat: any curve would
    do as well. None where there is no wave to try.
    """
    least = 2 * pi * SEEN / g.L
    if g.kind == "hinge":
        seen = tuple(n for n in g.turns if n >= least)
        if not seen:
            return None
        high = max(48.0, *seen)
        return Shape("n", "", seen, least, high, free=False, about="periods in a turn")
    grid = tuple(2 * pi * w / g.L for w in PERIODS)
    return Shape("n", "rad/m", grid, 0.9 * least, 2 * grid[-1], about="wave number")
