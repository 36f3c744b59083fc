"""Air drag on the platform."""

from math import sqrt

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import PLATFORM


@njit
def wrench(s, p):  # type: ignore[no-untyped-def]
    """(-c |v|^(n-1) v, 0) [N], v in m/s."""
    c, n = p
    k = -c * sqrt(s.vx**2 + s.vy**2 + s.vz**2) ** (n - 1)
    return k * s.vx, k * s.vy, k * s.vz, 0.0, 0.0, 0.0


AIR_DRAG = DriveEffect(
    Effect(
        "air_drag",
        "-c |v| v on the platform, or another power of |v|",
        (Size("c", "N s²/m²", 0.5, 0.01, sign=1, about="drag per power of speed"),),
        (Shape("n", "", (1.5, 2.0), 1.2, 4.0, free=False, about="the power"),),
        places=PLATFORM,
        phrase="platform: air drag",
        reference="Hoerner 1965, Fluid-Dynamic Drag",
    ),
    wrench=wrench,
)
