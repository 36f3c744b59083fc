"""Effects by rule: any parameter of a drive may differ at one drive, drift with time, or jump.

    p (1 + δ)              mismatch: δ at one drive
    p (1 - α t)            drift: of one drive or of all; t is the time of the record
    p (1 - α x), ẋ = i²    the same with heat: x is what the motor has lost, in seconds at 1 A
    p (1 + δ)  at t ≥ t_s  jump: at one drive, within a tenth of a second about t_s

A law says what a relative change c of a parameter adds; the three follow from it:

    λ      ΔT = c λ ε                             cable_elasticity
    b      ΔT = c b (ḋ - ḋ₀)                      cable_damping
    k_s    Δτ = -c k_s R_s² φ, as far as F_s goes     drum_spring
    b_v    Δτ = -c b_v ω                          viscous_friction
    b_c    Δτ = -c b_c tanh(β ω)                  friction
    R      ΔR = c R                               drum_radius
    K_t    Δi = c i                               torque_constant

A change of R_s acts as one of k_s: the torque of a drum spring depends on k_s R_s² alone. That of J
would need the acceleration, of which a force must not depend. Heat is not given off: a motor cools
within minutes, which is longer than a log. All drifts of a drive see one heat.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import tanh
from typing import Any

from numba import njit

from identification.effects.effect import Effect
from identification.effects.sizes import Onset, Shape, Size
from inca_mj.effects.hooks import DRIVES_EACH, ONE_DRIVE
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import AXES

LASTS = 0.1  # of a jump [s]: a step of the integrator that a jump divides would lose its order
# At which jumps are tried [s], by a factor of 1.7: the nearest one still shows some of what a jump
# between two of them does. Before a refit all times between its neighbours are tried.
TIMES = (1.0, 1.7, 2.9, 4.9, 8.4, 14.0, 24.0)
DRIFTING = 20.0  # [s] in which a parameter may lose as much as one drive may deviate
HEATED = Shape("kind", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0,
               about="0 with time, 1 with heat",
               words=("it changes with time", "it changes with heat"))  # fmt: skip
PROBE = 0.1  # of the largest plausible size: a cable that is 3 % softer moves an angle by 0.1 mrad


@njit
def cable_elasticity(s, c):
    return c * s.lambda_ * s.strain


@njit
def cable_damping(s, c):
    return c * s.b * s.strain_rate * s.d_0


@njit
def drum_spring(s, c):
    # the spring never pushes
    return s.R_s * max(-s.F_s, -c * s.k_s * s.R_s * s.phi)


@njit
def viscous_friction(s, c):
    return -c * s.b_v * s.omega


@njit
def friction(s, c):
    return -c * s.b_c * tanh(s.beta * s.omega)


@njit
def drum_radius(s, c):
    return c * s.R


@njit
def torque_constant(s, c):
    return c * s.i


@njit
def heat_rate(s, p):
    return s.i * s.i


@dataclass(frozen=True)
class _Rule:
    """The way in which a change of one parameter enters the law."""

    parameter: str  # its name
    law: Any  # what a relative change c adds
    hook: str  # where
    letter: str  # the parameter in formulas
    phrase: str  # what changes, in words
    largest: float  # the largest plausible relative deviation of one drive
    probe: float = 1.0  # share of the largest plausible drift at which its sensitivity is taken

    @property
    def name(self) -> str:
        """The parameter's word in the names of effects."""
        return str(self.law.__name__)


def _mismatch(rule: _Rule) -> Effect:
    law = rule.law

    @njit
    def mismatch(s, p):
        return law(s, p[0])

    return Effect(
        f"{rule.name}_mismatch",
        f"{rule.letter} (1 + δ) on one drive",
        (_delta(rule, "excess"),),
        places=ONE_DRIVE,
        phrase=f"{rule.phrase} differs at one drive",
        reference="thesis Table 3.2",
        hooks={rule.hook: mismatch},
    )


def _drift(rule: _Rule) -> Effect:
    law, largest = rule.law, rule.largest / DRIFTING

    @njit
    def drift(s, p):
        return law(s, -p[0] * (s.time if p[1] == 0.0 else s.x))

    about = f"relative loss of {rule.letter} a second, or a second at 1 A"
    return Effect(
        f"{rule.name}_drift",
        f"{rule.letter} (1 - α t), or with heat ∫(i/1 A)² dt for t",
        (Size("alpha", "1/s", largest, rule.probe * largest, about=about),),
        (HEATED,),
        places=DRIVES_EACH,
        phrase=f"{rule.phrase} drifts",
        reference="thesis Table 3.2",
        shares=True,
        hooks={rule.hook: drift, "rate": heat_rate},
    )


def _jump(rule: _Rule) -> Effect:
    law = rule.law

    @njit
    def jump(s, p):
        return law(s, p[0] * min(1.0, max(0.0, 0.5 + (s.time - p[1]) / LASTS)))

    return Effect(
        f"{rule.name}_jump",
        f"{rule.letter} (1 + δ) on one drive from t_s on",
        (_delta(rule, "change"),),
        (Shape("t_s", "s", TIMES, 0.1, 600.0, about="time of the jump in the record", step=LASTS),),
        places=ONE_DRIVE,
        phrase=f"{rule.phrase} jumps",
        reference="thesis Table 3.2",
        onset=Onset("t_s", LASTS),
        hooks={rule.hook: jump},
    )


def _delta(rule: _Rule, what: str) -> Size:
    about = f"relative {what} of {rule.letter}"
    return Size("delta", "", rule.largest, PROBE * rule.largest, about=about)


_RULES = (
    _Rule("lambda", cable_elasticity, "tension", "λ", "cable: elasticity", 0.3),
    _Rule("b", cable_damping, "tension", "b", "cable: damping", 1.0),
    _Rule("k_s", drum_spring, "torque", "k_s", "drum spring: stiffness", 0.3),
    _Rule("b_v", viscous_friction, "torque", "b_v", "friction: viscous part", 1.0),
    _Rule("b_c", friction, "torque", "b_c", "friction: Coulomb part", 0.5),
    _Rule("R", drum_radius, "radius", "R", "roller: radius", 0.05),
    # A torque moves the robot far: a small drift is probed.
    _Rule("K_t", torque_constant, "current", "K_t", "motor: torque constant", 0.2, probe=0.02),
)
# The effect, and its place, that a deviation of the model's parameters is when it is no scatter.
DEVIANTS = {
    **{
        f"{rule.parameter}@{k}": (f"{rule.name}_mismatch", f"drive {k}")
        for rule in _RULES
        for k in range(1, DRIVES + 1)
    },
    **{
        f"exit_{axis}@{k}": ("anchor_offset", f"drive {k}")
        for k in range(1, DRIVES + 1)
        for axis in AXES
    },
}

MISMATCHES = tuple(map(_mismatch, _RULES))
# A roller does not change its radius while it runs, but for the cable that piles up on it.
DRIFTS = tuple(_drift(rule) for rule in _RULES if rule.law is not drum_radius)
# It may jump: a cable that slips on its roller, a screw that comes loose.
JUMPS = tuple(map(_jump, _RULES))
