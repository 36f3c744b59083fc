"""Cables: how they stretch, creep and hang.

    T   = max(0, λ ε (1 + κ ε^n) + c λ (ε − ε_v) + b (ḋ − ḋ₀))        hardening, creep
    τ ε̇_v = ε − ε_v,  ε_v(0) = ε(0)                                   Maxwell branch, relaxed
    −½ ρ g d  along z, on the connector of each cable                 weight
    d + d (ρ g d_h)²/(24 T²)  for d in ε                              sag, where asked for

d_h is the horizontal span of the cable; the sag is the parabola's lengthening, solved with T.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import HiddenDriveEffect, HiddenNumbers


@dataclass(frozen=True, kw_only=True)
class HiddenCableHardening(HiddenDriveEffect):
    """λ ε (1 + κ ε^n)."""

    name: ClassVar[str] = "cable_hardening"
    acts_on: ClassVar[str] = "all cables"
    sizes: ClassVar[tuple[str, ...]] = ("kappa",)
    largest: ClassVar[float] = 2.0  # at a strain of 0.1 %: three times as stiff
    reach: ClassVar[float] = 1e-3
    positive: ClassVar[tuple[str, ...]] = ("exponent",)
    kappa: float = 200.0
    exponent: float = 1.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write κ and n."""
        self.column(numbers, at.CABLE_HARD)[:] += self.kappa
        self.column(numbers, at.CABLE_POWER)[:] = self.exponent


@dataclass(frozen=True, kw_only=True)
class HiddenCableCreep(HiddenDriveEffect):
    """A spring of c λ in series with a dashpot, time constant τ [s], relaxed at the start."""

    name: ClassVar[str] = "cable_creep"
    acts_on: ClassVar[str] = "all cables"
    sizes: ClassVar[tuple[str, ...]] = ("fraction",)
    largest: ClassVar[float] = 0.5  # a new braid that gives half as much again
    positive: ClassVar[tuple[str, ...]] = ("tau",)
    fraction: float = 0.1
    tau: float = 1.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write c and τ."""
        self.column(numbers, at.MAXWELL)[:] += self.fraction
        self.column(numbers, at.MAXWELL_TIME)[:] = self.tau


@dataclass(frozen=True, kw_only=True)
class HiddenCableWeight(HiddenDriveEffect):
    """ρ [kg/m]: half of each cable hangs on its connector, and sags where `sag` is True.

    Where `balanced` is False the pretension carries the platform alone and the weight acts from the
    first instant on, as an external force does.
    """

    name: ClassVar[str] = "cable_weight"
    acts_on: ClassVar[str] = "all cables"
    sizes: ClassVar[tuple[str, ...]] = ("rho",)
    largest: ClassVar[float] = 5e-3  # steel of 1 mm weighs 4 g/m [kg/m]
    rho: float = 6e-4
    sag: bool = False
    balanced: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write ρ and its options."""
        self.column(numbers, at.LINE_WEIGHT)[:] += self.rho
        self.column(numbers, at.SAG)[:] = self.sag
        numbers.weight_carried = self.balanced
