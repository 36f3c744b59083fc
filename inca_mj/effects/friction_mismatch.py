"""Friction mismatch: one drive rubs more, or less, than the others."""

from math import tanh

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import ONE_DRIVE


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -δ b_c tanh(β ω) [N m]: b_c (1 + δ) in all."""
    return -p[0] * s.b_c * tanh(s.beta * s.omega)


FRICTION_MISMATCH = DriveEffect(
    Effect(
        "friction_mismatch",
        "b_c (1 + δ) on one drive",
        (Size("delta", "", 0.5, 0.01, about="relative excess of Coulomb friction"),),
        places=ONE_DRIVE,
        phrase="friction: one drive differs",
        reference="thesis 2.39",
    ),
    torque=torque,
)
