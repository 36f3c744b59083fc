"""Asymmetric friction: brakes winding in, helps paying out."""

from math import tanh

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -f_a |tanh(β ω)| [N m]."""
    return -p[0] * abs(tanh(s.beta * s.omega))


ASYMMETRIC_FRICTION = DriveEffect(
    Effect(
        "asymmetric_friction",
        "-f_a |tanh(β ω)|",
        (Size("f_a", "N m", 0.003, 2e-4, about="friction winding in, less the mean of both ways"),),
        places=DRIVES_EACH,
        phrase="friction: more in one direction",
        reference="Janot, Gautier, Brunot 2019",
    ),
    torque=torque,
)
