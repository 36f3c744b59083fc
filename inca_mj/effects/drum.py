"""Rollers and drum springs.

    eccentricity        R (1 + a cos φ + b sin φ)         the radius swings once a turn
    layering            R + h φ                           the cable piles up on the roller
    backlash            a gap of ±h between rotor and drum
    spring hardening    F_s with k_s (1 + k₃ s²), s = R_s φ
    spring hysteresis   F_s (1 + η tanh(β ω))

Of backlash: a cable pulls and never pushes, and the drum weighs nothing beside the rotor. It rests
at that edge of the gap to which the cable pulls it, h behind the rotor, or floats in the gap
without load. The cable is R h longer than the rotor's angle says:

    T = λ (ε - R h/d)        zero, inside the gap, when that is negative

From a start in the middle of the gap the tension falls at once. A robot that has settled hides its
backlash as long as every cable stays taut.
"""

from math import cos, sin, tanh

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DRIVES_EACH

WAY = 0.05  # s₁, at which k₃ means the same for every power [m]


@njit
def drum_eccentricity(s, p):  # type: ignore[no-untyped-def]
    """ΔR = R (a cos φ + b sin φ) [m]."""
    return s.R * (p[0] * cos(s.phi) + p[1] * sin(s.phi))


@njit
def drum_layering(s, p):  # type: ignore[no-untyped-def]
    """ΔR = h φ [m]."""
    return p[0] * s.phi


@njit
def backlash(s, p):  # type: ignore[no-untyped-def]
    """ΔT = -λ R h/d [N]."""
    return -s.lambda_ * s.R * p[0] / s.d


@njit
def spring_hardening(s, p):  # type: ignore[no-untyped-def]
    """Δτ = R_s ΔF_s, ΔF_s = -k_s k₃ s³ |s/s₁|^(n-2), s = R_s φ [N m]; it never pushes."""
    k_3, n = p
    way = s.R_s * s.phi
    return s.R_s * max(-s.F_s, -s.k_s * k_3 * WAY * way * abs(way) * (abs(way) / WAY) ** (n - 1))


@njit
def spring_hysteresis(s, p):  # type: ignore[no-untyped-def]
    """Δτ = η R_s F_s tanh(β ω) [N m]: F_s (1 + η tanh(β ω)) in all."""
    return p[0] * s.R_s * s.F_s * tanh(s.beta * s.omega)


DRUM_ECCENTRICITY = Effect(
    "drum_eccentricity",
    "R (1 + a cos φ + b sin φ)",
    (
        Size("a", "", 0.05, 3e-4, about="cosine part over the radius"),
        Size("b", "", 0.05, 3e-4, about="sine part over the radius"),
    ),
    places=DRIVES_EACH,
    phrase="roller: eccentric",
    reference="thesis 2.30",
    hooks={"radius": drum_eccentricity},
)
DRUM_LAYERING = Effect(
    "drum_layering",
    "R + h φ",
    (Size("h", "m/rad", 1e-4, 4e-7, sign=1, about="growth of the radius per angle"),),
    places=DRIVES_EACH,
    phrase="roller: cable piles up",
    reference="Pott 2018, Cable-Driven Parallel Robots",
    hooks={"radius": drum_layering},
)
BACKLASH = Effect(
    "backlash",
    "dead zone of ±h between rotor and drum, the drum at the edge to which its cable pulls",
    (Size("h", "rad", 0.1, 2e-3, sign=1, about="half the gap"),),
    places=DRIVES_EACH,
    phrase="roller: backlash",
    reference="Nordin, Gutman 2002",
    hooks={"tension": backlash},
)
SPRING_HARDENING = Effect(
    "spring_hardening",
    "F_s with k_s (1 + k₃ s²), or with |s|; s = R_s φ",
    (Size("k_3", "1/m²", 500.0, 2.0, about="growth of the stiffness"),),
    (Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="power of the way"),),
    places=DRIVES_EACH,
    phrase="drum spring: stiffness not constant",
    reference="thesis 2.41",
    hooks={"torque": spring_hardening},
)
SPRING_HYSTERESIS = Effect(
    "spring_hysteresis",
    "F_s (1 + η tanh(β ω))",
    (Size("eta", "", 0.2, 2e-4, about="relative excess when winding in"),),
    places=DRIVES_EACH,
    phrase="drum spring: hysteresis",
    reference="Wahl 1963",
    hooks={"torque": spring_hysteresis},
)
