"""Effects of drives: frictions, motors and their currents, drums and springs.

Each friction brakes the rotor by

    Stribeck         f_s exp(−(|ω|/v_s)^n) tanh(βω)          n = 2, or another shape
    asymmetric       f_a |tanh(βω)|                          brakes winding, helps paying out
    load-dependent   μ R T tanh(βω)
    quadratic        c ω |ω|^(n − 1)                         n = 2, or another shape
    mismatch         δ b_c tanh(βω)
    by the angle     b_c (a cos φ + b sin φ) tanh(βω)        in no catalogue

From the commanded current to the torque of a motor:

    i_d(t) = i(t − Δ), zero before the first sample                            delay
    i_c    = clip(i_d, ±i_max), or i_max tanh(i_d/i_max) where soft            saturation
    τ i̇_m  = i_c − i_m,  i_m(0) = i_c(0)                                       lag
    Γ      = K_t (1 + δ) (1 − D(t) − α_h ∫ i_m² dt) i_m + a cos(nφ) + b sin(nφ)
    D(t)   = α t, or α τ_d (1 − e^(−t/τ_d)) where it settles                   drift

Drums and springs:

    R_k(φ) = R (1 + δ_k + a cos φ + b sin φ) + h φ          mismatch, eccentricity, layering
    ψ follows φ outside a gap of ±h, ψ(0) = φ(0) = 0         backlash: the play operator
    F_s = max(0, (R/R_s) T(0) − k_s s (1 + k₃ |s|^n)) (1 + η tanh(βω)),  s = R_s φ

Behind a backlash the cable is wound by ψ, while the load R T and the spring act on the rotor.
The spring balances the pretension on the true radius at φ = 0. By the letters of the law a positive
η feeds energy in; a spring that loses energy has η < 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi, sqrt
from typing import Self

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenEffect,
    HiddenNumbers,
    HiddenOneDriveEffect,
    shape,
    size,
)


@dataclass(frozen=True, kw_only=True)
class HiddenStribeckFriction(HiddenDriveEffect):
    """−f_s exp(−(|ω|/v_s)^n) tanh(βω); f_s [N m], v_s [rad/s]."""

    name = "stribeck_friction"
    largest = 0.04  # a winch at rest may hold twice its friction in motion [N m]
    f_s: float = size(0.01, at.STRIBECK)
    v_s: float = shape(1.2, at.STRIBECK_SPEED)
    exponent: float = shape(2.0, at.STRIBECK_POWER)


@dataclass(frozen=True, kw_only=True)
class HiddenAsymmetricFriction(HiddenDriveEffect):
    """−f_a |tanh(βω)|; f_a [N m]."""

    name = "asymmetric_friction"
    largest = 0.012  # 30 % of the friction of a winch, 0.04 [N m]
    f_a: float = size(0.002, at.ASYMMETRY)


@dataclass(frozen=True, kw_only=True)
class HiddenLoadDependentFriction(HiddenDriveEffect):
    """−μ R T tanh(βω)."""

    name = "load_dependent_friction"
    largest = 0.2  # small pulleys take up to 20 % of the load
    mu: float = size(0.004, at.LOAD)


@dataclass(frozen=True, kw_only=True)
class HiddenQuadraticFriction(HiddenDriveEffect):
    """−c ω |ω|^(n − 1); c [N m (s/rad)^n]."""

    name = "quadratic_friction"
    largest = 0.05  # at 50 rad/s [N m]
    reach = 50.0
    c: float = size(2e-6, at.QUADRATIC)
    exponent: float = shape(2.0, at.QUADRATIC_POWER)


@dataclass(frozen=True, kw_only=True)
class HiddenFrictionMismatch(HiddenOneDriveEffect):
    """b_c (1 + δ) on one drive."""

    name = "friction_mismatch"
    largest = 1.0  # a drive with twice the friction of the others
    delta: float = size(0.1, at.COULOMB_ERROR)


@dataclass(frozen=True, kw_only=True)
class HiddenPositionDependentFriction(HiddenDriveEffect):
    """b_c (1 + a cos φ + b sin φ) for b_c: a bent shaft; in no catalogue."""

    name = "position_dependent_friction"
    largest = 0.3  # 30 % of the friction
    a: float = size(0.2, at.ANGLE_COS)
    b: float = size(0.1, at.ANGLE_SIN)


@dataclass(frozen=True, kw_only=True)
class HiddenCogging(HiddenDriveEffect):
    """+ a cos(nφ) + b sin(nφ) [N m]."""

    name = "cogging"
    largest = 0.05  # torque of motors without a compensation of it [N m]
    a: float = size(2e-4, at.COG_COS)
    b: float = size(4e-4, at.COG_SIN)
    n: float = shape(6.0, at.COG_N)


@dataclass(frozen=True, kw_only=True)
class HiddenCurrentLag(HiddenDriveEffect):
    """First-order lag τ [s] of the current loop, which starts at the first current."""

    name = "current_lag"
    largest = 0.01  # a slow current loop [s]
    tau: float = size(1.5e-3, at.LAG)


@dataclass(frozen=True, kw_only=True)
class HiddenDelay(HiddenEffect):
    """Pure delay [s] of all currents, zero before the first sample."""

    name = "delay"
    acts_on = "all drives"
    largest = 0.01  # ten cycles of 1 kHz [s]
    delay: float = size(1.5e-3, at.DELAY)


@dataclass(frozen=True, kw_only=True)
class HiddenCurrentSaturation(HiddenDriveEffect):
    """Clip at ±i_max [A], or i_max tanh(i/i_max) where soft.

    Its size grows as i_max falls below `onset`, the largest current [A]; none is an infinite i_max.
    """

    name = "current_saturation"
    is_smooth = False  # a small loss is one of the peaks alone
    i_max: float = size(0.95, positive=True)
    soft: bool = shape(False, at.CURRENT_SOFT, positive=False)
    onset: float = shape(1.0)

    def put(self, numbers: HiddenNumbers) -> None:
        """Write i_max and its shape."""
        super().put(numbers)
        self.column(numbers, at.CURRENT_LIMIT)[:] = self.i_max

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

    name = "torque_constant_drift"
    largest = 5e-3  # 12 % in 24 s: magnets of a motor that heats up fast [1/s]
    alpha: float = size(5e-4)
    settle: float = shape(0.0, at.DRIFT_TIME, positive=False)
    heat: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write α where the shape reads it, and τ_d."""
        super().put(numbers)
        self.column(numbers, at.HEAT_LOSS if self.heat else at.DRIFT)[:] += self.alpha


@dataclass(frozen=True, kw_only=True)
class HiddenTorqueConstantMismatch(HiddenOneDriveEffect):
    """K_t (1 + δ) on one drive."""

    name = "torque_constant_mismatch"
    largest = 0.25  # a motor of the next winding
    delta: float = size(0.01, at.GAIN_ERROR)


@dataclass(frozen=True, kw_only=True)
class HiddenTorqueRippleTime(HiddenDriveEffect):
    """A torque a sin(2πf t + φ₀) [N m] that no log shows; in no catalogue. f [Hz], φ₀ [rad]."""

    name = "torque_ripple_time"
    largest = 0.05  # as cogging [N m]
    a: float = size(1e-3, at.RIPPLE)
    frequency: float = shape(3.7, at.RIPPLE_RATE, times=2 * pi)
    phase: float = shape(0.0, at.RIPPLE_PHASE, positive=False)


@dataclass(frozen=True, kw_only=True)
class HiddenDrumEccentricity(HiddenDriveEffect):
    """R (1 + a cos φ + b sin φ)."""

    name = "drum_eccentricity"
    largest = 0.03  # half a millimetre of a drum of 17.5 mm
    a: float = size(8e-4, at.ECC_COS)
    b: float = size(8e-4, at.ECC_SIN)


@dataclass(frozen=True, kw_only=True)
class HiddenDrumLayering(HiddenDriveEffect):
    """R + h φ; h [m/rad]."""

    name = "drum_layering"
    largest = 1e-4  # a cable of 0.6 mm, one turn on the other [m/rad]
    h: float = size(1e-5, at.LAYER)


@dataclass(frozen=True, kw_only=True)
class HiddenDrumRadiusMismatch(HiddenOneDriveEffect):
    """R (1 + δ) on one drive."""

    name = "drum_radius_mismatch"
    largest = 0.05  # a millimetre of a drum of 17.5 mm
    delta: float = size(6e-3, at.RADIUS_ERROR)


@dataclass(frozen=True, kw_only=True)
class HiddenBacklash(HiddenDriveEffect):
    """A dead zone of ±h [rad] between rotor and drum, which starts in its middle.

    From about 0.03 rad on, the robot's motion is chaotic: no two steps give the same 20 s.
    """

    name = "backlash"
    largest = 0.02  # a gap of two degrees [rad]
    h: float = size(0.01, at.PLAY)


@dataclass(frozen=True, kw_only=True)
class HiddenSpringHardening(HiddenDriveEffect):
    """k_s (1 + k₃ |s|^n), s = R_s φ [m]; k₃ [1/m^n]: n = 2 a cubic force, n = 1 a quadratic."""

    name = "spring_hardening"
    largest = 2.0  # at 0.2 m: three times as stiff
    reach = 0.2
    k_3: float = size(8.0, at.SPRING_HARD)
    exponent: float = shape(2.0, at.SPRING_POWER)


@dataclass(frozen=True, kw_only=True)
class HiddenSpringHysteresis(HiddenDriveEffect):
    """F_s (1 + η tanh(βω))."""

    name = "spring_hysteresis"
    largest = 0.1  # 10 % between loading and unloading
    eta: float = size(-0.02, at.SPRING_LOSS)
