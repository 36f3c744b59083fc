"""External force: something pulls at the platform, always the same way."""

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import PLATFORM


@njit
def wrench(s, p):  # type: ignore[no-untyped-def]
    """(G, 0): a constant force in O at the platform's centre [N]."""
    return p[0], p[1], p[2], 0.0, 0.0, 0.0


EXTERNAL_FORCE = DriveEffect(
    Effect(
        "external_force",
        "constant force (x, y, z) on the platform, fixed frame",
        (
            Size("x", "N", 1.0, 0.05, about="force along x"),
            Size("y", "N", 1.0, 0.05, about="force along y"),
            Size("z", "N", 1.0, 0.05, about="force along z"),
        ),
        places=PLATFORM,
        phrase="platform: constant force",
        reference="thesis 2.35",
    ),
    wrench=wrench,
)
