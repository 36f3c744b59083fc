"""Radius mismatch: one roller is larger, or smaller, than the others."""

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import ONE_DRIVE


@njit
def radius(s, p):  # type: ignore[no-untyped-def]
    """ΔR = δ R [m]."""
    return p[0] * s.R


DRUM_RADIUS_MISMATCH = DriveEffect(
    Effect(
        "drum_radius_mismatch",
        "R (1 + δ) on one drive",
        (Size("delta", "", 0.05, 1e-3, about="relative excess of the radius"),),
        places=ONE_DRIVE,
        phrase="roller: one radius differs",
        reference="thesis Table 2.1",
    ),
    radius=radius,
)
