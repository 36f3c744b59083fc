"""Cogging: the rotor's magnets prefer some angles."""

from math import cos, sin

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = a cos(n φ) + b sin(n φ) [N m]."""
    a, b, n = p
    return a * cos(n * s.phi) + b * sin(n * s.phi)


COGGING = DriveEffect(
    Effect(
        "cogging",
        "a cos(n φ) + b sin(n φ)",
        (
            Size("a", "N m", 0.02, 1e-4, about="cosine part of the torque"),
            Size("b", "N m", 0.02, 1e-4, about="sine part of the torque"),
        ),
        (
            Shape(
                "n", "", tuple(map(float, range(1, 25))), 1.0, 400.0, free=False, about="harmonic"
            ),
        ),
        DRIVES_EACH,
        "motor: cogging torque",
        "Holtz, Springob 1996",
    ),
    torque=torque,
)
