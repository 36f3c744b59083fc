"""Energy: at every state what goes in is what is stored and lost, and so over every trajectory.

One cable, taut. Stretched from d₀ to d it stores E_c = ½ λ ε² d₀, with ε = (d − d₀)/d₀, so

    Ė_c = λ ε ḋ − (λ ε + ½ λ ε²) ḋ₀.

It pulls with T on the platform (power −T ḋ) and with R T on the roller (power −R T ω_m). As
ḋ₀ = −R ω_m d₀/d, that is R ω_m = −(1 + ε) ḋ₀, cable and work together change by

    −T ḋ + T (1 + ε) ḋ₀ + Ė_c = −(T − λ ε) d₀ε̇ + ½ λ ε² ḋ₀,   d₀ε̇ = ḋ − (d/d₀) ḋ₀.

A slack cable has E_c = 0, and the same holds with ε⁺ = max(0, (d − d₀)/d₀) for ε. Both terms
have a meaning, and neither is an approximation:

* (T − λ ε⁺) d₀ε̇ is the power of the damper: its force times the rate at which the FREE cable
  stretches. The thesis' force uses ḋ − ḋ₀ instead of d₀ε̇ (2.31), so this is b (ḋ − ḋ₀)² only to
  first order in ε, and may be negative by a term of order ε.
* ½ λ ε² (−ḋ₀) = ½ λ ε² R ω_m d₀/d is elastic energy carried onto the roller: cable is wound up
  with its strain (2.26), and paid out with whatever strain the free part has (2.30). Winding in
  at one strain and paying out at another does not give the same energy back.

The whole robot, with E = E_kin + E_grav + E_ext + E_elastic + E_spring:

    Ė = Σ [K_t i ω_m − b_v ω_m² − b_c tanh(β ω_m) ω_m − (T − λ ε⁺) d₀ε̇ − ½ λ ε⁺² R ω_m d₀/d].
"""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from reference_cases import FORCE, FORCE_AT, currents, sets, states

from inca_mj.reference import derivative, pack, rest, rotation_matrix
from inca_mj.reference import layout as at
from inca_mj.reference.equations import cables
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set


class Energy(NamedTuple):
    """Stored energy [J]; `sum(energy)` is E."""

    kinetic: float  # ½ m v² + ½ ωᵀ I_P ω + Σ ½ J ω_m²
    gravitational: float  # m g z
    external: float  # −Gᵀ (p + R_AB b_G)
    elastic: float  # Σ ½ λ ε⁺² d₀ of the free cables
    spring: float  # of the drum springs, zero at φ_m = 0, constant once F_s is zero


class Power(NamedTuple):
    """Power into the robot [W]; `sum(power)` is Ė."""

    motor: float  # Σ K_t i ω_m
    viscous: float  # −Σ b_v ω_m²
    coulomb: float  # −Σ b_c tanh(β ω_m) ω_m
    damper: float  # −Σ (T − λ ε⁺) d₀ε̇ of the cables
    wound: float  # −Σ ½ λ ε⁺² R ω_m d₀/d, carried onto the rollers with the strained cable


def energy(x, q):
    """The energy stored at a state."""
    own = q[at.ROWS].reshape(at.DRIVES, at.ROW).T
    R, R_s, k_s, λ, J = own[[at.R, at.R_S, at.K_S, at.LAMBDA, at.J]]
    m, I_P = q[at.M], q[at.INERTIA]
    v, ω, ω_m, d_0 = x[at.VELOCITY], x[at.RATES], x[at.SPEEDS], x[at.NO_LOAD]
    d = cables(x, q)[1]
    ε = np.maximum(0.0, (d - d_0) / d_0)
    b_G = rotation_matrix(x[at.EULER]) @ q[at.FORCE_AT]

    # E_spring = −∫ F_s ds over s = R_s φ_m, with F_s = F_0 − k_s s until it reaches zero.
    F_0, s = R / R_s * q[at.PRETENSION], R_s * x[at.ANGLES]
    s = np.minimum(s, np.divide(F_0, k_s, out=np.full(at.DRIVES, np.inf), where=k_s > 0))
    return Energy(
        kinetic=float(0.5 * m * (v @ v) + 0.5 * (I_P * ω) @ ω + 0.5 * (J * ω_m) @ ω_m),
        gravitational=float(m * q[at.G_EARTH] * x[at.POSITION][2]),
        external=float(-q[at.FORCE] @ (x[at.POSITION] + b_G)),
        elastic=float(np.sum(0.5 * λ * ε**2 * d_0)),
        spring=float(-np.sum((F_0 - 0.5 * k_s * s) * s)),
    )


def power(x, i, q):
    """The power into the robot at a state."""
    own = q[at.ROWS].reshape(at.DRIVES, at.ROW).T
    λ, b_v, b_c, β, K_t = own[[at.LAMBDA, at.B_V, at.B_C, at.BETA, at.K_T]]
    ω_m, d_0 = x[at.SPEEDS], x[at.NO_LOAD]
    T, d, d_rate, d_0_rate, _ = cables(x, q)
    ε = np.maximum(0.0, (d - d_0) / d_0)
    stretching = d_rate - d / d_0 * d_0_rate  # d₀ε̇
    return Power(
        motor=float((K_t * i) @ ω_m),
        viscous=float(-(b_v * ω_m) @ ω_m),
        coulomb=float(-(b_c * np.tanh(β * ω_m)) @ ω_m),
        damper=float(-np.sum((T - λ * ε) * stretching)),
        wound=float(np.sum(0.5 * λ * ε**2 * d_0_rate)),
    )


@settings(deadline=None)
@given(states, currents, sets)
def test_energy_changes_at_the_power_at_any_state(x, i, name):
    q = pack(parameter_set(name), INCA, force=FORCE, force_at=FORCE_AT)
    rate = derivative(x, i, q)
    # Rounding of E limits short steps and curvature long ones; E is smooth through slackness.
    h = 1e-5 / np.abs(rate[at.SPEEDS]).max()
    change = sum(energy(x + h * rate, q)) - sum(energy(x - h * rate, q))
    flow = np.abs(power(x, i, q)).sum()
    assert change / (2 * h) == pytest.approx(sum(power(x, i, q)), abs=1e-5 * flow)


def test_a_spring_without_stiffness_pulls_with_a_constant_force():
    p = parameter_set("trial", {"k_s": 0.0})
    q, x = pack(p, INCA), rest(p, INCA).state.copy()
    x[at.ANGLES] = 2.0
    assert energy(x, q).spring == pytest.approx(-2.0 * 0.0175 * rest(p, INCA).tension.sum())
