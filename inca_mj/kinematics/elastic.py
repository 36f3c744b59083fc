"""No-load lengths and tensions of a robot with elastic cables, from its motor angles.

    d₀ = d₀(0) - ∫ R dφ/(1 + ε)                           what the rollers have wound  (thesis 2.30)
    d = d₀ (1 + T/λ),   ε = T/λ                           the cable at rest     (2.24, 2.25, 2.32)
    R T = K_t i + R_s F_s - b_v ω - b_c tanh(β ω) - J ω̇   balance of a drum, corrected  (2.39, 2.40)
    F_s = max(0, (R/R_s) T(0) - k_s R_s φ)                drum spring, corrected            (2.41)
    W T = w + m (v̇, …)                                    balance of the platform     (2.33 - 2.36)

(2.30) is dd₀ = -R dφ d₀/d, and d₀/d = 1/(1 + ε): the roller winds the cable as strained as it is.
So d₀ depends on the path, but only weakly, because ε is about 2e-4 to 5e-4. For one measurement,
of which the path is not known, the strain is taken as the mean of both ends:

    d₀ ≈ d₀(0) - R φ/(1 + (ε(0) + ε)/2)

The error is R |φ| times the difference between that mean and the true mean of ε along the path, so
at most half the spread of ε on the way: 0.1 mm for 0.9 m of cable. Along a log the path is known,
and the integral is computed by the trapezoidal rule from sample to sample.

At rest a drum may be held by its dry friction anywhere within ±b_c: the tension that its balance
gives has the std b_c/(√3 R). The tanh of (2.39) has no such rest; the twin creeps until no
friction is left."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.robot.elastic import Robot

Array = np.ndarray


@dataclass(frozen=True, kw_only=True)
class Measured:
    """Measurements at N instants, a row each.

    Attributes:
        angles: φ, shape (N, 8) [rad].
        currents: i, shape (N, 8) [A].
        rates: ω, shape (N, 8) [rad/s].
        rate_changes: ω̇, shape (N, 8) [rad/s^2].
        rate_noise: std of ω̇ that noise of the angles makes, over their std [1/s^2].
    """

    angles: Array
    currents: Array
    rates: Array
    rate_changes: Array
    rate_noise: float = 0.0


def drum_tension(robot: Robot, measured: Measured) -> Array:
    """Returns T that balances each drum, shape (N, 8) [N] (thesis 2.39 - 2.41, corrected)."""
    R, R_s, φ, ω = robot.R, robot.R_s, measured.angles, measured.rates
    F_s = np.maximum(0, R / R_s * robot.tension - robot.k_s * R_s * φ)
    friction = robot.b_v * ω + robot.b_c * np.tanh(robot.beta * ω)
    return (
        robot.K_t * measured.currents + R_s * F_s - friction - robot.J * measured.rate_changes
    ) / R


def no_load_at_rest(angles: Array, robot: Robot, T: Array) -> tuple[Array, Array]:
    """Returns d₀ of a measurement and its derivative by T (thesis 2.30, mean strain of both ends).

    Args:
        angles: φ, shape (N, 8) [rad]; the first, so that they can be bound.
        robot: its numbers.
        T: tensions, shape (N, 8) [N].

    Returns:
        d₀ (N, 8) [m], and ∂d₀/∂T (N, 8) [m/N].
    """
    stretch = 1 + (robot.tension + T) / (2 * robot.lambda_)
    wound = robot.R * angles / stretch
    return robot.no_load - wound, wound / stretch / (2 * robot.lambda_)


def no_load_along(robot: Robot, angles: Array, T: Array) -> Array:
    """Returns d₀ along a log that begins at rest, all angles zero, shape (N, 8) [m] (thesis 2.30).

    Args:
        robot: its numbers.
        angles: φ from sample to sample, shape (N, 8) [rad].
        T: tensions there, shape (N, 8) [N].
    """
    taken = 1 - 1 / (1 + T / robot.lambda_)  # ε/(1 + ε): the part of R dφ that is strain
    first = (1 - 1 / (1 + (robot.tension + T[0]) / (2 * robot.lambda_))) * angles[0]
    steps = np.diff(angles, axis=0) * (taken[1:] + taken[:-1]) / 2
    strained = np.concatenate([first[None], first + np.cumsum(steps, axis=0)])
    return robot.no_load - robot.R * (angles - strained)
