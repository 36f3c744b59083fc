"""Cables: how they stretch, creep and hang.

    hardening    λ ε (1 + κ ε)                            braids stiffen as they are pulled
    creep        ΔT = c λ (ε - x),  τ ẋ = ε - x           a Maxwell branch beside the elastic cable
    weight       F = (0, 0, -ρ g d/2) on the connector    half of each hangs there, half at its exit

The branch of the creep is a spring and a damper in series; x is the strain of the damper, and the
branch is relaxed at the start.
"""

from math import sqrt

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import CABLES
from inca_mj.robot.parameters import GRAVITY

STRAIN = 1e-3  # ε₁, at which κ means the same for every power


@njit
def cable_hardening(s, p):  # type: ignore[no-untyped-def]
    """ΔT = λ κ ε² (ε/ε₁)^(n-1) of a taut cable [N]: λ ε (1 + κ ε) in all where n = 1."""
    kappa, n = p
    strain = max(0.0, s.strain)
    return s.lambda_ * kappa * strain**2 * (strain / STRAIN) ** (n - 1)


@njit
def cable_creep(s, p):  # type: ignore[no-untyped-def]
    """ΔT = c λ (ε - x) [N], x the strain of the damper, at which the branch is relaxed."""
    return p[0] * s.lambda_ * (s.strain - s.x)


@njit
def creep_rate(s, p):  # type: ignore[no-untyped-def]
    """ẋ = (ε - x)/τ."""
    return (s.strain - s.x) / p[1]


@njit
def creep_start(s, p):  # type: ignore[no-untyped-def]
    """x(0) = ε(0)."""
    return s.strain


@njit
def cable_weight(s, p):  # type: ignore[no-untyped-def]
    """F = (0, 0, -ρ g d/2) on the connector [N]."""
    d = sqrt(s.rx**2 + s.ry**2 + s.rz**2)
    return 0.0, 0.0, -0.5 * GRAVITY * p[0] * d


CABLE_HARDENING = Effect(
    "cable_hardening",
    "λ ε (1 + κ ε), or with ε²",
    (Size("kappa", "", 2000.0, 200.0, sign=1, about="growth of the stiffness per strain"),),
    (Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="power of the strain", usual=1.0),),
    places=CABLES,
    phrase="cable: stiffer when pulled",
    reference="Miermeister, Kraus, Lan, Pott 2015",
    hooks={"tension": cable_hardening},
)
CABLE_CREEP = Effect(
    "cable_creep",
    "a Maxwell branch beside λ: stiffness c λ, time constant τ",
    (Size("c", "", 0.5, 0.1, sign=1, about="stiffness of the branch over λ"),),
    (Shape("tau", "s", (0.1, 0.3, 1.0, 3.0, 10.0), 0.02, 100.0, about="its time constant"),),
    places=CABLES,
    phrase="cable: creeps",
    reference="Miermeister, Kraus, Lan, Pott 2015",
    hooks={"tension": cable_creep, "rate": creep_rate, "start": creep_start},
)
CABLE_WEIGHT = Effect(
    "cable_weight",
    "ρ d/2 of each cable hangs on its connector",
    (Size("rho", "kg/m", 0.005, 1e-3, sign=1, about="mass of the cable per length"),),
    places=CABLES,
    phrase="cable: has weight",
    reference="Irvine 1981, Cable Structures",
    hooks={"force": cable_weight},
)
