"""Quadratic friction: fluid or air that the roller stirs."""

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -c ω |ω|^(n-1) [N m], ω in rad/s."""
    c, n = p
    return -c * s.omega * abs(s.omega) ** (n - 1)


QUADRATIC_FRICTION = DriveEffect(
    Effect(
        "quadratic_friction",
        "-c ω |ω|, or another power of |ω|",
        (Size("c", "N m s²/rad²", 1e-5, 2e-8, sign=1, about="friction per power of speed"),),
        (Shape("n", "", (1.5, 2.0, 3.0), 1.2, 4.0, free=False, about="the power"),),
        places=DRIVES_EACH,
        phrase="friction: grows with the square of the speed",
        reference="Olsson, Åström, Canudas de Wit, Gäfvert, Lischinsky 1998",
    ),
    torque=torque,
)
