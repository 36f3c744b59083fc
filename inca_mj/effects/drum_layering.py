"""Layering: the cable piles up on the roller."""

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def radius(s, p):  # type: ignore[no-untyped-def]
    """ΔR = h φ [m]."""
    return p[0] * s.phi


DRUM_LAYERING = DriveEffect(
    Effect(
        "drum_layering",
        "R + h φ",
        (Size("h", "m/rad", 1e-4, 4e-7, sign=1, about="growth of the radius per angle"),),
        places=DRIVES_EACH,
        phrase="roller: cable piles up",
        reference="Pott 2018, Cable-Driven Parallel Robots",
    ),
    radius=radius,
)
