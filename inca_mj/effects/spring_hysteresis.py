"""Hysteresis of the drum spring: its force depends on the way it turns."""

from math import tanh

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = η R_s F_s tanh(β ω) [N m]: F_s (1 + η tanh(β ω)) in all."""
    return p[0] * s.R_s * s.F_s * tanh(s.beta * s.omega)


SPRING_HYSTERESIS = DriveEffect(
    Effect(
        "spring_hysteresis",
        "F_s (1 + η tanh(β ω))",
        (Size("eta", "", 0.2, 2e-4, about="relative excess when winding in"),),
        places=DRIVES_EACH,
        phrase="drum spring: hysteresis",
        reference="Wahl 1963",
    ),
    torque=torque,
)
