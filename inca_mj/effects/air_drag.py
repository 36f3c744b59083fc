"""Air drag on the platform."""

from math import sqrt

from numba import njit

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import PLATFORM


@njit
def wrench(s, p):  # type: ignore[no-untyped-def]
    """(-c |v| v, 0) [N]."""
    k = -p[0] * sqrt(s.vx**2 + s.vy**2 + s.vz**2)
    return k * s.vx, k * s.vy, k * s.vz, 0.0, 0.0, 0.0


AIR_DRAG = DriveEffect(
    Effect(
        "air_drag",
        "-c |v| v on the platform",
        (Size("c", "N s²/m²", 0.5, 0.01, sign=1, about="drag per squared speed"),),
        places=PLATFORM,
        phrase="platform: air drag",
        reference="Hoerner 1965, Fluid-Dynamic Drag",
    ),
    wrench=wrench,
)
