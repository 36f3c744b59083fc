"""The law of a cable drive that MJCF lacks, one equation a function, compiled by numba.

    ε   = (d - d₀)/d₀                          strain                      (thesis 2.25)
    ḋ₀  = -R ω d₀/d                            roller-dependent no-load length      (2.30)
    T   = max(0, λ ε + b (ḋ - ḋ₀))             a cable pulls, it never pushes       (2.32)
    F_s = max(0, (R/R_s) T(0) - k_s R_s φ)     drum spring                          (2.41)
    τ_c = b_c tanh(β ω)                        smooth Coulomb friction              (2.39)
    J ω̇ = K_t i - R T + R_s F_s - b_v ω - τ_c                                       (2.40)

Positive φ and positive i wind the cable in. Misprints of the thesis, and what stands here:
2.40 has the load torque's sign reversed under "positive winds"; 2.41 has R_s/R where the static
balance R T(0) = R_s F_s demands R/R_s. K_t i, b_v and J are MuJoCo's own (gear, joint damping,
armature); the rest is added by `inca_mj.twin.native`.

All numbers live in mjModel arrays, so that `Batch.expand` gives every simulation its own:
a cable's in its tendon's row of `tendon_user`, a drive's in its current actuator's row of
`actuator_user`, at the columns named here.
"""

from __future__ import annotations

from math import exp

from numba import njit

TAG = 6208.0  # first entry of a row that this law reads; other models' rows are left alone

# columns of tendon_user, a row per cable
TENDON_TAG, LAMBDA, B = 0, 1, 2
TENDON_COLUMNS = 3

# columns of actuator_user, a row per drive; CABLE is the id of the tendon that it winds
ACTUATOR_TAG, R, R_S, K_S, B_C, BETA, T_0, CABLE = 0, 1, 2, 3, 4, 5, 6, 7
ACTUATOR_COLUMNS = 8

TENSION, NO_LOAD_LENGTH = 1, 2  # what a user sensor on a drive shows: its sensor_user[0]


@njit
def no_load_rate(d: float, d_0: float, omega: float, R: float) -> float:
    """Returns the rate ḋ₀ of the no-load length [m/s]: the roller winds the strained cable."""
    return -R * omega * d_0 / d


@njit
def tension(
    d: float, d_dot: float, d_0: float, d_0_dot: float, lambda_: float, b: float, more: float = 0.0
) -> float:  # fmt: skip
    """Returns the tension of the cable T [N], zero when slack; `more` is what effects add."""
    T = lambda_ * (d - d_0) / d_0 + b * (d_dot - d_0_dot) + more
    return 0.0 if T < 0.0 else T  # written so that NaN stays NaN


@njit
def spring_force(phi: float, R: float, R_s: float, k_s: float, T_0: float) -> float:
    """Returns the force of the drum spring F_s [N].

    Args:
        phi: motor angle φ, positive winds in [rad].
        R: radius of the roller [m].
        R_s: radius of the spring drum [m].
        k_s: spring constant [N/m].
        T_0: tension that it balances at φ = 0 [N].
    """
    F_s = R / R_s * T_0 - k_s * R_s * phi
    return 0.0 if F_s < 0.0 else F_s


@njit
def coulomb_friction(omega: float, b_c: float, beta: float) -> float:
    """Returns the smooth Coulomb friction torque τ_c [N m]."""
    return b_c * (1.0 - 2.0 / (1.0 + exp(2.0 * beta * omega)))  # tanh, at half its cost
