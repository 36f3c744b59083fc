"""Current saturation: the amplifier gives no more than a current i_max.

A limit has no size that is zero when it is absent, so the size here is a share of the clipping:
0 is none, 1 is a real limit.
"""

from math import tanh

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH

# dense where a log of the thesis has its currents, then by a factor of 1.4 [A]
GRID = (0.55, 0.65, 0.75, 0.85, 0.95, 1.2, 1.7, 2.4, 3.4, 4.8)


@njit
def current(s, p):  # type: ignore[no-untyped-def]
    """Δi = c (clip(i, ±i_max) - i), or with i_max tanh(i/i_max) where soft [A]."""
    c, i_max, soft = p
    limited = i_max * tanh(s.i / i_max) if soft else max(-i_max, min(i_max, s.i))
    return c * (limited - s.i)


CURRENT_SATURATION = DriveEffect(
    Effect(
        "current_saturation",
        "i clipped at ±i_max, or i_max tanh(i/i_max)",
        (
            Size(
                "c",
                "",
                1.0,
                0.02,
                sign=1,
                present=1.0,
                about="share of the clipping, 1 when there is a limit",
            ),
        ),
        (
            Shape("i_max", "A", GRID, 0.05, 20.0, about="the limit"),
            Shape(
                "soft",
                "",
                (0.0, 1.0),
                0.0,
                1.0,
                free=False,
                about="1: it bends, does not clip",
                usual=0.0,
            ),
        ),
        DRIVES_EACH,
        "motor: current clipped",
        "data sheet of the amplifier",
    ),
    current=current,
)
