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
    kind,
    shape,
    size,
)


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


KINDS = (
    # a winch at rest may hold twice its friction in motion; f_s [N m], v_s [rad/s]
    kind("stribeck_friction", HiddenDriveEffect, 0.04,
         f_s=size(0.01, at.STRIBECK), v_s=shape(1.2, at.STRIBECK_SPEED),
         exponent=shape(2.0, at.STRIBECK_POWER)),
    # 30 % of the friction of a winch, 0.04 N m
    kind("asymmetric_friction", HiddenDriveEffect, 0.012, f_a=size(0.002, at.ASYMMETRY)),
    # small pulleys take up to 20 % of the load
    kind("load_dependent_friction", HiddenDriveEffect, 0.2, mu=size(0.004, at.LOAD)),
    # 0.05 N m at 50 rad/s; c [N m (s/rad)^n]
    kind("quadratic_friction", HiddenDriveEffect, 0.05, reach=50.0,
         c=size(2e-6, at.QUADRATIC), exponent=shape(2.0, at.QUADRATIC_POWER)),
    # a drive with twice the friction of the others
    kind("friction_mismatch", HiddenOneDriveEffect, 1.0, delta=size(0.1, at.COULOMB_ERROR)),
    # 30 % of the friction: a bent shaft
    kind("position_dependent_friction", HiddenDriveEffect, 0.3,
         a=size(0.2, at.ANGLE_COS), b=size(0.1, at.ANGLE_SIN)),
    # torque of motors without a compensation of it [N m]
    kind("cogging", HiddenDriveEffect, 0.05,
         a=size(2e-4, at.COG_COS), b=size(4e-4, at.COG_SIN), n=shape(6.0, at.COG_N)),
    # a slow current loop [s]
    kind("current_lag", HiddenDriveEffect, 0.01, tau=size(1.5e-3, at.LAG)),
    # ten cycles of 1 kHz [s]
    kind("delay", HiddenEffect, 0.01, acts_on="all drives", delay=size(1.5e-3, at.DELAY)),
    HiddenCurrentSaturation,
    HiddenTorqueConstantDrift,
    # a motor of the next winding
    kind("torque_constant_mismatch", HiddenOneDriveEffect, 0.25, delta=size(0.01, at.GAIN_ERROR)),
    # a torque a sin(2πf t + φ₀) that no log shows, as large as cogging [N m]; f [Hz], φ₀ [rad]
    kind("torque_ripple_time", HiddenDriveEffect, 0.05, a=size(1e-3, at.RIPPLE),
         frequency=shape(3.7, at.RIPPLE_RATE, times=2 * pi),
         phase=shape(0.0, at.RIPPLE_PHASE, positive=False)),
    # half a millimetre of a drum of 17.5 mm
    kind("drum_eccentricity", HiddenDriveEffect, 0.03,
         a=size(8e-4, at.ECC_COS), b=size(8e-4, at.ECC_SIN)),
    # a cable of 0.6 mm, one turn on the other [m/rad]
    kind("drum_layering", HiddenDriveEffect, 1e-4, h=size(1e-5, at.LAYER)),
    # a millimetre of a drum of 17.5 mm
    kind("drum_radius_mismatch", HiddenOneDriveEffect, 0.05, delta=size(6e-3, at.RADIUS_ERROR)),
    # A gap of two degrees [rad], that starts in its middle. From about 0.03 rad on, the robot's
    # motion is chaotic: no two steps give the same 20 s.
    kind("backlash", HiddenDriveEffect, 0.02, h=size(0.01, at.PLAY)),
    # at 0.2 m three times as stiff; k₃ [1/m^n]: n = 2 a cubic force, n = 1 a quadratic
    kind("spring_hardening", HiddenDriveEffect, 2.0, reach=0.2,
         k_3=size(8.0, at.SPRING_HARD), exponent=shape(2.0, at.SPRING_POWER)),
    # 10 % between loading and unloading
    kind("spring_hysteresis", HiddenDriveEffect, 0.1, eta=size(-0.02, at.SPRING_LOSS)),
)  # fmt: skip
