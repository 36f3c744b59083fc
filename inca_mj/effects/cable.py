"""Rollers, drum springs and cables.

    drum eccentricity   R (1 + a cos φ + b sin φ)         the radius swings once a turn
    drum layering       R + h φ                           the cable piles up on the roller
    backlash            a gap of ±h between rotor and drum
    spring hardening    F_s with k_s (1 + k₃ s²), s = R_s φ
    spring hysteresis   F_s (1 + η tanh(β ω))
    cable hardening     λ ε (1 + κ ε)                     braids stiffen as they are pulled
    cable creep         ΔT = c λ (ε - x),  τ ẋ = ε - x    a Maxwell branch beside the elastic cable
    pulley radius       Δd = r_p β + ℓ - √(h² + z²)       a swivelling pulley at the exit point
    cable weight        F = (0, 0, -ρ g d/2)              half hangs on the connector
    anchor offset       Δd = |r - o| - |r|                an exit point is not where it should be

Backlash: a cable pulls and never pushes, and the drum weighs nothing beside the rotor. It rests at
that edge of the gap to which the cable pulls it, h behind the rotor, or floats in the gap without
load. The cable is R h longer than the rotor's angle says: T = λ (ε - R h/d), zero, inside the gap,
when that is negative. From a start in the middle of the gap the tension falls at once. A robot that
has settled hides its backlash as long as every cable stays taut.

Creep: a spring and a damper in series, relaxed at the start; x is the strain of the damper.

Pulley: the cable enters it at A along the vertical and leaves along the tangent towards the
connector B; the pulley swivels about that vertical. It enters upwards into a low pulley and
downwards into a high one, or, where it runs over, the other way: then it turns farther. With h the
horizontal and z the vertical distance from A to B, z in the direction of the entering cable:

    D² = (h - r_p)² + z²,  ℓ = √(D² - r_p²)                  tangent
    β  = angle over which the cable lies on the pulley

Its gradient is the tangent's direction less that of B - A.
"""

from math import atan2, cos, sin, sqrt, tanh

from numba import njit

from identification.effects.sizes import Shape, Size
from inca_mj.effects.hooks import CABLES, ONE_DRIVE, by_law
from inca_mj.robot.parameters import GRAVITY

WAY = 0.05  # s₁, at which k₃ means the same for every power [m]
STRAIN = 1e-3  # ε₁, at which κ means the same for every power
_POTT = "Pott 2018, Cable-Driven Parallel Robots"
_MIERMEISTER = "Miermeister, Kraus, Lan, Pott 2015"


@njit
def drum_eccentricity(s, p):
    return s.R * (p[0] * cos(s.phi) + p[1] * sin(s.phi))


@njit
def drum_layering(s, p):
    return p[0] * s.phi


@njit
def backlash(s, p):
    return -s.lambda_ * s.R * p[0] / s.d


@njit
def spring_hardening(s, p):
    """Δτ = R_s ΔF_s, ΔF_s = -k_s k₃ s³ |s/s₁|^(n-2) [N m]; the spring never pushes."""
    k_3, n = p
    way = s.R_s * s.phi
    return s.R_s * max(-s.F_s, -s.k_s * k_3 * WAY * way * abs(way) * (abs(way) / WAY) ** (n - 1))


@njit
def spring_hysteresis(s, p):
    return p[0] * s.R_s * s.F_s * tanh(s.beta * s.omega)


@njit
def cable_hardening(s, p):
    """ΔT = λ κ ε² (ε/ε₁)^(n-1) of a taut cable [N]: λ ε (1 + κ ε) in all where n = 1."""
    kappa, n = p
    strain = max(0.0, s.strain)
    return s.lambda_ * kappa * strain**2 * (strain / STRAIN) ** (n - 1)


@njit
def cable_creep(s, p):
    return p[0] * s.lambda_ * (s.strain - s.x)


@njit
def creep_rate(s, p):
    return (s.strain - s.x) / p[1]


@njit
def creep_start(s, p):
    return s.strain


@njit
def pulley_radius(s, p):
    """Returns Δd and ∂Δd/∂r, r = B - A."""
    r_p, over = p
    across = sqrt(s.rx**2 + s.ry**2)
    sign = 1.0 if (s.rz >= 0.0) != (over != 0.0) else -1.0  # low drives look up, high ones down
    z = sign * s.rz
    straight = sqrt(across**2 + z**2)
    tangent = sqrt((across - r_p) ** 2 + z**2 - r_p**2)
    # B from the centre: tangent (sin β, cos β) + r_p (-cos β, sin β)
    beta = atan2(tangent * (across - r_p) + r_p * z, tangent * z - r_p * (across - r_p))
    out, up = sin(beta), sign * cos(beta)
    return (
        r_p * beta + tangent - straight,
        (out / across - 1.0 / straight) * s.rx,
        (out / across - 1.0 / straight) * s.ry,
        up - s.rz / straight,
    )


@njit
def cable_weight(s, p):
    d = sqrt(s.rx**2 + s.ry**2 + s.rz**2)
    return 0.0, 0.0, -0.5 * GRAVITY * p[0] * d


@njit
def anchor_offset(s, p):
    """Returns Δd and ∂Δd/∂r; r = B - A, o the offset of A."""
    x, y, z = s.rx - p[0], s.ry - p[1], s.rz - p[2]
    old, new = sqrt(s.rx**2 + s.ry**2 + s.rz**2), sqrt(x**2 + y**2 + z**2)
    return new - old, x / new - s.rx / old, y / new - s.ry / old, z / new - s.rz / old


OF_CABLES = (
    by_law(drum_eccentricity, "radius", "R (1 + a cos φ + b sin φ)",
           (Size("a", "", 0.05, 3e-4, about="cosine part over the radius"),
            Size("b", "", 0.05, 3e-4, about="sine part over the radius")),
           phrase="roller: eccentric", reference="thesis 2.30"),
    by_law(drum_layering, "radius", "R + h φ",
           (Size("h", "m/rad", 1e-4, 4e-7, sign=1, about="growth of the radius per angle"),),
           phrase="roller: cable piles up", reference=_POTT),
    by_law(backlash, "tension",
           "dead zone of ±h between rotor and drum, the drum at the edge to which its cable pulls",
           (Size("h", "rad", 0.1, 2e-3, sign=1, about="half the gap"),),
           phrase="roller: backlash", reference="Nordin, Gutman 2002"),
    by_law(spring_hardening, "torque", "F_s with k_s (1 + k₃ s²), or with |s|; s = R_s φ",
           (Size("k_3", "1/m²", 500.0, 2.0, about="growth of the stiffness"),),
           (Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="power of the way"),),
           phrase="drum spring: stiffness not constant", reference="thesis 2.41"),
    by_law(spring_hysteresis, "torque", "F_s (1 + η tanh(β ω))",
           (Size("eta", "", 0.2, 2e-4, about="relative excess when winding in"),),
           phrase="drum spring: hysteresis", reference="Wahl 1963"),
    by_law(cable_hardening, "tension", "λ ε (1 + κ ε), or with ε²",
           (Size("kappa", "", 2000.0, 200.0, sign=1, about="growth of the stiffness per strain"),),
           (Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="power of the strain",
                  usual=1.0),),
           places=CABLES, phrase="cable: stiffer when pulled", reference=_MIERMEISTER),
    by_law(cable_creep, "tension", "a Maxwell branch beside λ: stiffness c λ, time constant τ",
           (Size("c", "", 0.5, 0.1, sign=1, about="stiffness of the branch over λ"),),
           (Shape("tau", "s", (0.1, 0.3, 1.0, 3.0, 10.0), 0.02, 100.0,
                  about="its time constant"),),
           places=CABLES, phrase="cable: creeps", reference=_MIERMEISTER,
           rate=creep_rate, start=creep_start),
    by_law(pulley_radius, "path", "swivelling pulley of radius r_p at A_i",
           (Size("r_p", "m", 0.03, 1e-3, sign=1, about="radius of the pulley"),),
           (Shape("over", "", (0.0, 1.0), 0.0, 1.0, free=False, about="1: over it", usual=0.0,
                  words=("the cable runs under the pulley", "the cable runs over the pulley")),),
           places=CABLES, phrase="cable: pulley at the exit point",
           reference="Pott 2012, Influence of pulley kinematics on cable-driven parallel robots"),
    by_law(cable_weight, "force", "ρ d/2 of each cable hangs on its connector",
           (Size("rho", "kg/m", 0.005, 1e-3, sign=1, about="mass of the cable per length"),),
           places=CABLES, phrase="cable: has weight",
           reference="Irvine 1981, Cable Structures"),
    by_law(anchor_offset, "path", "A_k moved by (x, y, z)",
           tuple(Size(axis, "m", 0.03, 1e-3, about="offset of the exit point") for axis in "xyz"),
           places=ONE_DRIVE, phrase="geometry: an exit point is elsewhere", reference=_POTT),
)  # fmt: skip
