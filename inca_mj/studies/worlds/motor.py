"""Motors and their currents: from the commanded current to the torque.

i_d(t) = i(t − Δ), zero before the first sample                            delay
i_c    = clip(i_d, ±i_max), or i_max tanh(i_d/i_max) where soft            saturation
τ i̇_m  = i_c − i_m,  i_m(0) = i_c(0)                                       lag
Γ      = K_t (1 + δ) (1 − D(t) − α_h ∫ i_m² dt) i_m + a cos(nφ) + b sin(nφ)
D(t)   = α t, or α τ_d (1 − e^(−t/τ_d)) where it settles                   drift
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi, sqrt
from typing import ClassVar, Self

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenEffect,
    HiddenNumbers,
    HiddenOneDriveEffect,
)


@dataclass(frozen=True, kw_only=True)
class HiddenCogging(HiddenDriveEffect):
    """+ a cos(nφ) + b sin(nφ) [N m]."""

    name: ClassVar[str] = "cogging"
    sizes: ClassVar[tuple[str, ...]] = ("a", "b")
    largest: ClassVar[float] = 0.05  # torque of motors without a compensation of it [N m]
    positive: ClassVar[tuple[str, ...]] = ("n",)
    a: float = 2e-4
    b: float = 4e-4
    n: float = 6.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write a, b and n."""
        self.column(numbers, at.COG_COS)[:] += self.a
        self.column(numbers, at.COG_SIN)[:] += self.b
        self.column(numbers, at.COG_N)[:] = self.n


@dataclass(frozen=True, kw_only=True)
class HiddenCurrentLag(HiddenDriveEffect):
    """First-order lag τ [s] of the current loop, which starts at the first current."""

    name: ClassVar[str] = "current_lag"
    sizes: ClassVar[tuple[str, ...]] = ("tau",)
    largest: ClassVar[float] = 0.01  # a slow current loop [s]
    tau: float = 1.5e-3

    def put(self, numbers: HiddenNumbers) -> None:
        """Write τ."""
        self.column(numbers, at.LAG)[:] += self.tau


@dataclass(frozen=True, kw_only=True)
class HiddenDelay(HiddenEffect):
    """Pure delay [s] of all currents, zero before the first sample."""

    name: ClassVar[str] = "delay"
    acts_on: ClassVar[str] = "all drives"
    sizes: ClassVar[tuple[str, ...]] = ("delay",)
    largest: ClassVar[float] = 0.01  # ten cycles of 1 kHz [s]
    delay: float = 1.5e-3

    def put(self, numbers: HiddenNumbers) -> None:
        """Write Δ."""
        numbers.P[at.DELAY] += self.delay


@dataclass(frozen=True, kw_only=True)
class HiddenCurrentSaturation(HiddenDriveEffect):
    """Clip at ±i_max [A], or i_max tanh(i/i_max) where soft.

    Its size grows as i_max falls below `onset`, the largest current [A]; none is an infinite i_max.
    """

    name: ClassVar[str] = "current_saturation"
    is_smooth: ClassVar[bool] = False  # a small loss is one of the peaks alone
    sizes: ClassVar[tuple[str, ...]] = ("i_max",)
    positive: ClassVar[tuple[str, ...]] = ("i_max", "onset")
    i_max: float = 0.95
    soft: bool = False
    onset: float = 1.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write i_max and its shape."""
        self.column(numbers, at.CURRENT_LIMIT)[:] = self.i_max
        self.column(numbers, at.CURRENT_SOFT)[:] = self.soft

    def scaled(self, factor: float) -> Self:
        """Returns a saturation that takes `factor` times as much of the largest current."""
        if factor == 0:
            return replace(self, i_max=inf)
        if self.soft:  # i − i_max tanh(i/i_max) ≈ i³/(3 i_max²)
            return replace(self, i_max=self.i_max / sqrt(factor))
        return replace(self, i_max=max(1e-3, self.onset - factor * (self.onset - self.i_max)))


@dataclass(frozen=True, kw_only=True)
class HiddenTorqueConstantDrift(HiddenDriveEffect):
    """K_t (1 − α t), α [1/s]; settling with `settle` τ_d [s] where that is not zero.

    Where `heat` is True the drift is α ∫ i² dt instead, α [1/(A^2 s)].
    """

    name: ClassVar[str] = "torque_constant_drift"
    sizes: ClassVar[tuple[str, ...]] = ("alpha",)
    largest: ClassVar[float] = 5e-3  # 12 % in 24 s: magnets of a motor that heats up fast [1/s]
    alpha: float = 5e-4
    settle: float = 0.0
    heat: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write α where the shape reads it, and τ_d."""
        self.column(numbers, at.HEAT_LOSS if self.heat else at.DRIFT)[:] += self.alpha
        self.column(numbers, at.DRIFT_TIME)[:] = self.settle


@dataclass(frozen=True, kw_only=True)
class HiddenTorqueConstantMismatch(HiddenOneDriveEffect):
    """K_t (1 + δ) on one drive."""

    name: ClassVar[str] = "torque_constant_mismatch"
    sizes: ClassVar[tuple[str, ...]] = ("delta",)
    largest: ClassVar[float] = 0.25  # a motor of the next winding
    delta: float = 0.01

    def put(self, numbers: HiddenNumbers) -> None:
        """Write δ."""
        self.column(numbers, at.GAIN_ERROR)[:] += self.delta


@dataclass(frozen=True, kw_only=True)
class HiddenTorqueRippleTime(HiddenDriveEffect):
    """A torque a sin(2πf t + φ₀) [N m] that no log shows; in no catalogue. f [Hz], φ₀ [rad]."""

    name: ClassVar[str] = "torque_ripple_time"
    sizes: ClassVar[tuple[str, ...]] = ("a",)
    largest: ClassVar[float] = 0.05  # as cogging [N m]
    positive: ClassVar[tuple[str, ...]] = ("frequency",)
    a: float = 1e-3
    frequency: float = 3.7
    phase: float = 0.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write a, 2πf and φ₀."""
        self.column(numbers, at.RIPPLE)[:] += self.a
        self.column(numbers, at.RIPPLE_RATE)[:] = 2 * pi * self.frequency
        self.column(numbers, at.RIPPLE_PHASE)[:] = self.phase
