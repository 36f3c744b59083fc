"""Effects of joints with states of their own: gears that swing or have a gap, friction that gives.

    series   (c, ε, J, ζ, side, d_m)  of the motor behind the gear: compliance, half the gap,
                                    inertia, damping ratio, where the encoder sits (1: motor, 0:
                                    link), and viscous friction of the motor
    slip     c                      compliance of the friction before it slips

    joint elasticity   c     gear backlash   ε; its teeth are stiff and hardly rebound
    motor damping      d_m, beside a gear that gives
    presliding         c = 1/σ

J = ρ I, I being the inertia that the joint's drive feels, ρ the motor's share. What these numbers
do is compiled in `identification.native.joints.gear`; with sizes of zero they do nothing. Sources:
Spong (1987) for elastic joints, Nordin and Gutman (2002) for gaps, Dahl (1968) for presliding.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from identification.effects.effect import Effect
from identification.effects.laws.joint_group import PROBE, Group
from identification.effects.sizes import Shape, Size
from identification.quantities import per

# Largest plausible sizes, as shares of half the travel: under the drive's full force a gear gives
# by less (harmonic drives by a tenth of that), its gap is smaller (good gears have less than a
# degree), and a friction of a tenth of that force slips before it has let the joint go by a tenth.
FLEXES, GAPS, GIVES = 0.05, 0.02, 1.0
SHARES = (0.12, 0.3, 0.6)  # of the inertia, of a motor of which the model says nothing
LEAST, MOST = 0.02, 0.9  # share of the inertia that a motor may have
# Probes: what swings shows itself only near its own frequency, what gives does so at any size.
SWINGS, OPENS, SLIPS = (5.0, 10.0, 20.0, 35.0, 60.0), (5.0, 30.0), (0.5, 5.0, 60.0)
# A friction on which the inertia swings in less than 2π times three steps of the simulation is one
# that holds: in units of the compliance on which it swings once in 2π steps.
LEAST_GIVE = 9.0
LINK = Shape("link", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0,
             about="0: the encoder sits on the motor's side, 1: on the link's",
             words=("the encoder is on the motor's side", "the encoder is on the link's side"),
             )  # fmt: skip


@njit
def joint_elasticity(s, p):
    c, rho, zeta, link = p
    return c, 0.0, rho * s.inertia, zeta, 1.0 - link, 0.0


@njit
def gear_backlash(s, p):
    eps, rho, link = p
    return 0.0, eps, rho * s.inertia, 0.0, 1.0 - link, 0.0


@njit
def motor_damping(s, p):
    return 0.0, 0.0, 0.0, 0.0, 0.0, p[0]


@njit
def presliding(s, p):
    return p[0]


def state_effects(g: Group) -> list[Effect]:
    """Returns effects with states on some joints; the caller leaves out those without a place."""
    zeta = Shape("zeta", "", (0.05,), 1e-3, 1.0, about="damping ratio of motor and spring")
    give = per(g.x, g.f)
    least = LEAST_GIVE * max(a.give for a in g.axes)
    return [
        g.effect("series", joint_elasticity, "τ = δ/c + 2 ζ √(J/c) dδ/dt, δ = θ - q",
                 "gear: gives elastically",
                 Size("c", give, FLEXES * g.A / g.F, PROBE * FLEXES * g.A / g.F, 1, "compliance"),
                 shapes=(_share(g), zeta, LINK), probes=SWINGS, places=g.plain,
                 reference="Spong 1987"),
        g.effect("series", gear_backlash, "τ = 0 while |θ - q| < ε", "gear: has a gap",
                 Size("eps", g.x, GAPS * g.A, PROBE * GAPS * g.A, 1, "half the gap"),
                 shapes=(_share(g), LINK), probes=OPENS, places=g.plain,
                 reference="Nordin, Gutman 2002"),
        g.effect("series", motor_damping, "-d_m ω on the motor behind a gear that gives",
                 "friction: viscous, on the motor's side of the gear",
                 g.size("d_m", 0.3 * g.F / g.V, f"{g.f} s/{g.x}", "damping of the motor", 1),
                 places=g.plain, needs=f"{g.prefix}joint_elasticity"),
        g.effect("slip", presliding, "c dp/dt = v - |v| p/b, p the friction, b its largest",
                 "friction: gives before it slips",
                 Size("c", give, GIVES * g.A / g.F, PROBE * GIVES * g.A / g.F, 1, "compliance",
                      smallest=least),
                 probes=SLIPS, reference="Dahl 1968"),
    ]  # fmt: skip


def _share(g: Group) -> Shape:
    """Returns the motor's share of the inertia: from the armatures, or else some values to try."""
    known = [a.share for a in g.axes if a.share > 0]
    grid = (float(np.clip(np.median(known), 2 * LEAST, 0.9 * MOST)),) if known else SHARES
    return Shape("rho", "", grid, LEAST, MOST, about="share of the inertia that the motor has")
