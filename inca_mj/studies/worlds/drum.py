"""Drums and springs.

    R_k(φ) = R (1 + δ_k + a cos φ + b sin φ) + h φ          mismatch, eccentricity, layering
    ψ follows φ outside a gap of ±h, ψ(0) = φ(0) = 0         backlash: the play operator
    F_s = max(0, (R/R_s) T(0) − k_s s (1 + k₃ |s|^n)) (1 + η tanh(βω)),  s = R_s φ

Behind a backlash the cable is wound by ψ, while the load R T and the spring act on the rotor.
The spring balances the pretension on the true radius at φ = 0. By the letters of the law a positive
η feeds energy in; a spring that loses energy has η < 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import HiddenDriveEffect, HiddenNumbers, HiddenOneDriveEffect


@dataclass(frozen=True, kw_only=True)
class HiddenDrumEccentricity(HiddenDriveEffect):
    """R (1 + a cos φ + b sin φ)."""

    name: ClassVar[str] = "drum_eccentricity"
    sizes: ClassVar[tuple[str, ...]] = ("a", "b")
    largest: ClassVar[float] = 0.03  # half a millimetre of a drum of 17.5 mm
    a: float = 8e-4
    b: float = 8e-4

    def put(self, numbers: HiddenNumbers) -> None:
        """Write a and b."""
        self.column(numbers, at.ECC_COS)[:] += self.a
        self.column(numbers, at.ECC_SIN)[:] += self.b


@dataclass(frozen=True, kw_only=True)
class HiddenDrumLayering(HiddenDriveEffect):
    """R + h φ; h [m/rad]."""

    name: ClassVar[str] = "drum_layering"
    sizes: ClassVar[tuple[str, ...]] = ("h",)
    largest: ClassVar[float] = 1e-4  # a cable of 0.6 mm, one turn on the other [m/rad]
    h: float = 1e-5

    def put(self, numbers: HiddenNumbers) -> None:
        """Write h."""
        self.column(numbers, at.LAYER)[:] += self.h


@dataclass(frozen=True, kw_only=True)
class HiddenDrumRadiusMismatch(HiddenOneDriveEffect):
    """R (1 + δ) on one drive."""

    name: ClassVar[str] = "drum_radius_mismatch"
    sizes: ClassVar[tuple[str, ...]] = ("delta",)
    largest: ClassVar[float] = 0.05  # a millimetre of a drum of 17.5 mm
    delta: float = 6e-3

    def put(self, numbers: HiddenNumbers) -> None:
        """Write δ."""
        self.column(numbers, at.RADIUS_ERROR)[:] += self.delta


@dataclass(frozen=True, kw_only=True)
class HiddenBacklash(HiddenDriveEffect):
    """A dead zone of ±h [rad] between rotor and drum, which starts in its middle.

    From about 0.03 rad on, the robot's motion is chaotic: no two steps give the same 20 s.
    """

    name: ClassVar[str] = "backlash"
    sizes: ClassVar[tuple[str, ...]] = ("h",)
    largest: ClassVar[float] = 0.02  # a gap of two degrees [rad]
    h: float = 0.01

    def put(self, numbers: HiddenNumbers) -> None:
        """Write h."""
        self.column(numbers, at.PLAY)[:] += self.h


@dataclass(frozen=True, kw_only=True)
class HiddenSpringHardening(HiddenDriveEffect):
    """k_s (1 + k₃ |s|^n), s = R_s φ [m]; k₃ [1/m^n]: n = 2 a cubic force, n = 1 a quadratic."""

    name: ClassVar[str] = "spring_hardening"
    sizes: ClassVar[tuple[str, ...]] = ("k_3",)
    largest: ClassVar[float] = 2.0  # at 0.2 m: three times as stiff
    reach: ClassVar[float] = 0.2
    positive: ClassVar[tuple[str, ...]] = ("exponent",)
    k_3: float = 8.0
    exponent: float = 2.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write k₃ and n."""
        self.column(numbers, at.SPRING_HARD)[:] += self.k_3
        self.column(numbers, at.SPRING_POWER)[:] = self.exponent


@dataclass(frozen=True, kw_only=True)
class HiddenSpringHysteresis(HiddenDriveEffect):
    """F_s (1 + η tanh(βω))."""

    name: ClassVar[str] = "spring_hysteresis"
    sizes: ClassVar[tuple[str, ...]] = ("eta",)
    largest: ClassVar[float] = 0.1  # 10 % between loading and unloading
    eta: float = -0.02

    def put(self, numbers: HiddenNumbers) -> None:
        """Write η."""
        self.column(numbers, at.SPRING_LOSS)[:] += self.eta
