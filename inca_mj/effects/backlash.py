"""Backlash: the drum follows the motor only outside a gap of ±h.

    play       x follows φ at the edges of the gap, |φ - x| <= h, and stands inside   (kind 0)
    dead zone  the drum stands while |φ| < h, and turns with the motor beyond         (kind 1)

The drum's rate, ẋ = g ω, winds the cable: ḋ₀ = -R g ω d₀/d, that is R + ΔR with ΔR = -R (1 - g).
The motor carries the load inside the gap too. The share g rises from 0 to 1 over the last
quarter of the gap and beyond its edge to 2, which brings back what a step has overshot. At a
standstill g is 1: nothing is lost.
"""

from numba import njit

from identification.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH

EDGE = 4.0  # the gap's half-width over the width of its edge


@njit
def share(s, p):  # type: ignore[no-untyped-def]
    """g: rate of the drum over that of the motor."""
    h, kind = p
    if s.omega == 0.0 or h <= 0.0:
        return 1.0
    if kind == 0.0:
        gone = s.phi - s.x if s.omega > 0.0 else s.x - s.phi
        return min(2.0, max(0.0, 1.0 + EDGE * (gone / h - 1.0)))
    return min(1.0, max(0.0, 0.5 + EDGE * (abs(s.phi) / h - 1.0)))


@njit
def radius(s, p):  # type: ignore[no-untyped-def]
    """ΔR = -R (1 - g) [m]."""
    return s.R * (share(s, p) - 1.0)


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = ΔR T [N m]: the load stays on the motor."""
    return radius(s, p) * s.T


@njit
def rate(s, p):  # type: ignore[no-untyped-def]
    """ẋ = g ω: angle of the drum."""
    return share(s, p) * s.omega


BACKLASH = DriveEffect(
    Effect(
        "backlash",
        "dead zone of ±h between rotor and drum",
        (Size("h", "rad", 0.1, 5e-3, sign=1, about="half the gap"),),
        (Shape("kind", "", (0.0, 1.0), 0.0, 1.0, free=False, about="0 play, 1 dead zone"),),
        DRIVES_EACH,
        "roller: backlash",
        "Nordin, Gutman 2002",
    ),
    radius=radius,
    torque=torque,
    rate=rate,
)
