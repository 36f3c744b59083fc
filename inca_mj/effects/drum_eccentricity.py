"""Eccentric roller: its radius swings once a turn."""

from math import cos, sin

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def radius(s, p):  # type: ignore[no-untyped-def]
    """ΔR = R (a cos φ + b sin φ) [m]."""
    return s.R * (p[0] * cos(s.phi) + p[1] * sin(s.phi))


DRUM_ECCENTRICITY = DriveEffect(
    Effect(
        "drum_eccentricity",
        "R (1 + a cos φ + b sin φ)",
        (
            Size("a", "", 0.05, 3e-4, about="cosine part over the radius"),
            Size("b", "", 0.05, 3e-4, about="sine part over the radius"),
        ),
        places=DRIVES_EACH,
        phrase="roller: eccentric",
        reference="thesis 2.30",
    ),
    radius=radius,
)
