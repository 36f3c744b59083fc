"""Anchor offset: one exit point is not where it should be."""

from math import sqrt

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import ONE_DRIVE


@njit
def path(s, p):  # type: ignore[no-untyped-def]
    """Δd = |r - o| - |r|, with ∂Δd/∂r; r = B - A, o the offset of A."""
    x, y, z = s.rx - p[0], s.ry - p[1], s.rz - p[2]
    old, new = sqrt(s.rx**2 + s.ry**2 + s.rz**2), sqrt(x**2 + y**2 + z**2)
    return new - old, x / new - s.rx / old, y / new - s.ry / old, z / new - s.rz / old


ANCHOR_OFFSET = DriveEffect(
    Effect(
        "anchor_offset",
        "A_k moved by (x, y, z)",
        (
            Size("x", "m", 0.03, 1e-3, about="offset of the exit point"),
            Size("y", "m", 0.03, 1e-3, about="offset of the exit point"),
            Size("z", "m", 0.03, 1e-3, about="offset of the exit point"),
        ),
        places=ONE_DRIVE,
        phrase="geometry: an exit point is elsewhere",
        reference="Pott 2018, Cable-Driven Parallel Robots",
    ),
    path=path,
)
