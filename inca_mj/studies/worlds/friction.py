"""Frictions of a drive [N m]; each brakes the rotor by

Stribeck         f_s exp(−(|ω|/v_s)^n) tanh(βω)          n = 2, or another shape
asymmetric       f_a |tanh(βω)|                          brakes winding, helps paying out
load-dependent   μ R T tanh(βω)
quadratic        c ω |ω|^(n − 1)                         n = 2, or another shape
mismatch         δ b_c tanh(βω)
by the angle     b_c (a cos φ + b sin φ) tanh(βω)        in no catalogue
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import HiddenDriveEffect, HiddenNumbers, HiddenOneDriveEffect


@dataclass(frozen=True, kw_only=True)
class HiddenStribeckFriction(HiddenDriveEffect):
    """−f_s exp(−(|ω|/v_s)^n) tanh(βω); f_s [N m], v_s [rad/s]."""

    name: ClassVar[str] = "stribeck_friction"
    sizes: ClassVar[tuple[str, ...]] = ("f_s",)
    largest: ClassVar[float] = 0.04  # a winch at rest may hold twice its friction in motion [N m]
    positive: ClassVar[tuple[str, ...]] = ("v_s", "exponent")
    f_s: float = 0.01
    v_s: float = 1.2
    exponent: float = 2.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write f_s, v_s and n."""
        self.column(numbers, at.STRIBECK)[:] += self.f_s
        self.column(numbers, at.STRIBECK_SPEED)[:] = self.v_s
        self.column(numbers, at.STRIBECK_POWER)[:] = self.exponent


@dataclass(frozen=True, kw_only=True)
class HiddenAsymmetricFriction(HiddenDriveEffect):
    """−f_a |tanh(βω)|; f_a [N m]."""

    name: ClassVar[str] = "asymmetric_friction"
    sizes: ClassVar[tuple[str, ...]] = ("f_a",)
    largest: ClassVar[float] = 0.012  # 30 % of the friction of a winch, 0.04 [N m]
    f_a: float = 0.002

    def put(self, numbers: HiddenNumbers) -> None:
        """Write f_a."""
        self.column(numbers, at.ASYMMETRY)[:] += self.f_a


@dataclass(frozen=True, kw_only=True)
class HiddenLoadDependentFriction(HiddenDriveEffect):
    """−μ R T tanh(βω)."""

    name: ClassVar[str] = "load_dependent_friction"
    sizes: ClassVar[tuple[str, ...]] = ("mu",)
    largest: ClassVar[float] = 0.2  # small pulleys take up to 20 % of the load
    mu: float = 0.004

    def put(self, numbers: HiddenNumbers) -> None:
        """Write μ."""
        self.column(numbers, at.LOAD)[:] += self.mu


@dataclass(frozen=True, kw_only=True)
class HiddenQuadraticFriction(HiddenDriveEffect):
    """−c ω |ω|^(n − 1); c [N m (s/rad)^n]."""

    name: ClassVar[str] = "quadratic_friction"
    sizes: ClassVar[tuple[str, ...]] = ("c",)
    largest: ClassVar[float] = 0.05  # at 50 rad/s [N m]
    reach: ClassVar[float] = 50.0
    positive: ClassVar[tuple[str, ...]] = ("exponent",)
    c: float = 2e-6
    exponent: float = 2.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write c and n."""
        self.column(numbers, at.QUADRATIC)[:] += self.c
        self.column(numbers, at.QUADRATIC_POWER)[:] = self.exponent


@dataclass(frozen=True, kw_only=True)
class HiddenFrictionMismatch(HiddenOneDriveEffect):
    """b_c (1 + δ) on one drive."""

    name: ClassVar[str] = "friction_mismatch"
    sizes: ClassVar[tuple[str, ...]] = ("delta",)
    largest: ClassVar[float] = 1.0  # a drive with twice the friction of the others
    delta: float = 0.1

    def put(self, numbers: HiddenNumbers) -> None:
        """Write δ."""
        self.column(numbers, at.COULOMB_ERROR)[:] += self.delta


@dataclass(frozen=True, kw_only=True)
class HiddenPositionDependentFriction(HiddenDriveEffect):
    """b_c (1 + a cos φ + b sin φ) for b_c: a bent shaft; in no catalogue."""

    name: ClassVar[str] = "position_dependent_friction"
    sizes: ClassVar[tuple[str, ...]] = ("a", "b")
    largest: ClassVar[float] = 0.3  # 30 % of the friction
    a: float = 0.2
    b: float = 0.1

    def put(self, numbers: HiddenNumbers) -> None:
        """Write a and b."""
        self.column(numbers, at.ANGLE_COS)[:] += self.a
        self.column(numbers, at.ANGLE_SIN)[:] += self.b
