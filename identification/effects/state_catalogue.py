"""Candidate effects of joints with states of their own; their laws are in `state_laws`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.effects import state_laws as laws
from identification.effects.effect import Effect, Shape, Size
from identification.effects.joint_group import PROBE, Group
from identification.native.element import Function
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
             about="0: the encoder sits on the motor's side, 1: on the link's")  # fmt: skip


def state_effects(g: Group) -> list[Effect]:
    """Returns effects with states on some joints; the caller leaves out those without a place."""
    zeta = Shape("zeta", "", (0.05,), 1e-3, 1.0, about="damping ratio of motor and spring")
    give = per(g.x, g.f)
    return [
        _effect(g, "series", laws.joint_elasticity, "τ = δ/c + 2 ζ √(J/c) dδ/dt, δ = θ - q",
                Size("c", give, FLEXES * g.A / g.F, PROBE * FLEXES * g.A / g.F, 1, "compliance"),
                (_share(g), zeta, LINK), SWINGS, "gear: gives elastically", "Spong 1987",
                g.plain),
        _effect(g, "series", laws.gear_backlash, "τ = 0 while |θ - q| < ε",
                Size("eps", g.x, GAPS * g.A, PROBE * GAPS * g.A, 1, "half the gap"),
                (_share(g), LINK), OPENS, "gear: has a gap", "Nordin, Gutman 2002", g.plain),
        _effect(g, "slip", laws.presliding, "c dp/dt = v - |v| p/b, p the friction, b its largest",
                Size("c", give, GIVES * g.A / g.F, PROBE * GIVES * g.A / g.F, 1, "compliance",
                     smallest=LEAST_GIVE * max(a.give for a in g.axes)),
                (), SLIPS, "friction: gives before it slips", "Dahl 1968", g.at),
    ]  # fmt: skip


def _share(g: Group) -> Shape:
    """Returns the motor's share of the inertia: from the armatures, or else some values to try."""
    known = [a.share for a in g.axes if a.share > 0]
    grid = (float(np.clip(np.median(known), 2 * LEAST, 0.9 * MOST)),) if known else SHARES
    return Shape("rho", "", grid, LEAST, MOST, about="share of the inertia that the motor has")


def _effect(
    g: Group, hook: str, law: Function, said: str, size: Size, shapes: tuple[Shape, ...],
    probes: tuple[float, ...], phrase: str, reference: str, where: Mapping[str, str],
) -> Effect:  # fmt: skip
    return Effect(
        g.prefix + law.__name__, said, (size,), shapes, phrase=g.told(phrase),
        reference=reference,
        places=where, probes=probes, hooks={hook: law},
    )  # fmt: skip
