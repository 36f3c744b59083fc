"""Load-dependent friction: pulleys and bearings that rub with the tension."""

from math import tanh

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -μ R T tanh(β ω) [N m]."""
    return -p[0] * s.R * s.T * tanh(s.beta * s.omega)


LOAD_DEPENDENT_FRICTION = DriveEffect(
    Effect(
        "load_dependent_friction",
        "-μ R T tanh(β ω)",
        (Size("mu", "", 0.1, 1e-4, sign=1, about="friction per load torque"),),
        places=DRIVES_EACH,
        phrase="friction: grows with the tension",
        reference="Torres-Charry, Gómez-Mendoza 2022",
    ),
    torque=torque,
)
