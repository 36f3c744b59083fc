"""Frictions of a drive: torques Δτ on its motor [N m], with the smooth sign tanh(β ω).

Stribeck          -f_s exp(-|ω/v_s|^n) tanh(β ω)      a peak of friction at low speed
asymmetric        -f_a |tanh(β ω)|                    brakes winding in, helps paying out
load-dependent    -μ R T tanh(β ω)                    pulleys and bearings rub with the tension
quadratic         -c ω |ω|^(n-1)                      fluid or air that the roller stirs
"""

from math import exp, tanh

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DRIVES_EACH


@njit
def stribeck_friction(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -f_s exp(-|ω/v_s|^n) tanh(β ω) [N m]."""
    f_s, v_s, n = p
    return -f_s * exp(-(abs(s.omega / v_s) ** n)) * tanh(s.beta * s.omega)


@njit
def asymmetric_friction(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -f_a |tanh(β ω)| [N m]."""
    return -p[0] * abs(tanh(s.beta * s.omega))


@njit
def load_dependent_friction(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -μ R T tanh(β ω) [N m]."""
    return -p[0] * s.R * s.T * tanh(s.beta * s.omega)


@njit
def quadratic_friction(s, p):  # type: ignore[no-untyped-def]
    """Δτ = -c ω |ω|^(n-1) [N m], ω in rad/s."""
    c, n = p
    return -c * s.omega * abs(s.omega) ** (n - 1)


STRIBECK_FRICTION = Effect(
    "stribeck_friction",
    "-f_s exp(-|ω/v_s|^n) tanh(β ω)",
    (Size("f_s", "N m", 0.02, 1e-3, sign=1, about="height of the peak, but for tanh(βω)"),),
    (
        Shape(
            "v_s",
            "rad/s",
            (0.3, 0.6, 1.2, 2.4, 5.0),
            0.05,
            20.0,
            about="rate at which it has fallen to 1/e",
        ),
        Shape("n", "", (1.0, 2.0), 0.5, 3.0, free=False, about="the power"),
    ),
    places=DRIVES_EACH,
    phrase="friction: Stribeck peak",
    reference="Armstrong-Hélouvry, Dupont, Canudas de Wit 1994",
    hooks={"torque": stribeck_friction},
)
ASYMMETRIC_FRICTION = Effect(
    "asymmetric_friction",
    "-f_a |tanh(β ω)|",
    (Size("f_a", "N m", 0.003, 2e-4, about="friction winding in, less the mean of both ways"),),
    places=DRIVES_EACH,
    phrase="friction: more in one direction",
    reference="Janot, Gautier, Brunot 2019",
    hooks={"torque": asymmetric_friction},
)
LOAD_DEPENDENT_FRICTION = Effect(
    "load_dependent_friction",
    "-μ R T tanh(β ω)",
    (Size("mu", "", 0.1, 1e-4, sign=1, about="friction per load torque"),),
    places=DRIVES_EACH,
    phrase="friction: grows with the tension",
    reference="Torres-Charry, Gómez-Mendoza 2022",
    hooks={"torque": load_dependent_friction},
)
QUADRATIC_FRICTION = Effect(
    "quadratic_friction",
    "-c ω |ω|, or another power of |ω|",
    (Size("c", "N m s²/rad²", 1e-5, 2e-8, sign=1, about="friction per power of speed"),),
    (Shape("n", "", (1.5, 2.0, 3.0), 1.2, 4.0, free=False, about="the power"),),
    places=DRIVES_EACH,
    phrase="friction: grows with the square of the speed",
    reference="Olsson, Åström, Canudas de Wit, Gäfvert, Lischinsky 1998",
    hooks={"torque": quadratic_friction},
)
