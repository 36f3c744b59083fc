"""Stribeck friction: a peak of friction at low speed (Armstrong-Hélouvry 1994)."""

from math import exp, tanh

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -f_s exp(-|ω/v_s|^n) tanh(β ω) [N m]."""
    f_s, v_s, n = p
    return -f_s * exp(-(abs(s.omega / v_s) ** n)) * tanh(s.beta * s.omega)


STRIBECK_FRICTION = DriveEffect(
    Effect(
        "stribeck_friction",
        "-f_s exp(-|ω/v_s|^n) tanh(β ω)",
        (Size("f_s", "N m", 0.02, 1e-3, sign=1, about="height of the peak"),),
        (
            Shape("v_s", "rad/s", (0.3, 0.6, 1.2, 2.4, 5.0), 0.05, 20.0, about="its half width"),
            Shape("n", "", (1.0, 2.0), 0.5, 3.0, free=False, about="the power"),
        ),
        DRIVES_EACH,
        "friction: Stribeck peak",
        "Armstrong-Hélouvry, Dupont, Canudas de Wit 1994",
    ),
    torque=torque,
)
