"""Quadratic friction: fluid or air that the roller stirs."""

from numba import njit

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -c ω |ω| [N m]."""
    return -p[0] * s.omega * abs(s.omega)


QUADRATIC_FRICTION = DriveEffect(
    Effect(
        "quadratic_friction",
        "-c ω |ω|",
        (Size("c", "N m s²/rad²", 1e-5, 2e-8, sign=1, about="friction per squared speed"),),
        places=DRIVES_EACH,
        phrase="friction: grows with the square of the speed",
        reference="Olsson, Åström, Canudas de Wit, Gäfvert, Lischinsky 1998",
    ),
    torque=torque,
)
