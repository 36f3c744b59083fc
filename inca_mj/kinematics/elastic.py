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

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY
from inca_mj.robot.spread import at_drives, displaced

Array = np.ndarray


@dataclass(frozen=True, kw_only=True)
class ElasticRobot:
    """The numbers of a robot whose pose is sought; arrays have one entry for each drive.

    Attributes:
        geometry: where the anchors are, displacements included.
        pose: where all angles are zero, shape (6,) [m, rad].
        T_0: tensions there, shape (8,) [N].
        d_0: no-load lengths there, shape (8,) [m].
        R: radius of the rollers, shape (8,) [m].
        R_s: radius of the spring drums, shape (8,) [m].
        k_s: constant of the drum springs, shape (8,) [N/m].
        K_t: torque constant, shape (8,) [N m/A].
        J: inertia of the motors, shape (8,) [kg m^2].
        b_v: viscous friction, shape (8,) [N m s/rad].
        b_c: Coulomb friction, shape (8,) [N m].
        beta: its smoothness, shape (8,) [s/rad].
        lambda_: elastic modulus of the cables, shape (8,) [N].
        m: mass of the platform [kg].
        gyration: its mean radius of gyration, squared [m^2].
    """

    geometry: Geometry
    pose: Array
    T_0: Array
    d_0: Array
    R: Array
    R_s: Array
    k_s: Array
    K_t: Array
    J: Array
    b_v: Array
    b_c: Array
    beta: Array
    lambda_: Array
    m: float
    gyration: float

    @property
    def weight(self) -> Array:
        """Wrench w that the cables carry at rest, in O, shape (6,) [N, N m]."""
        return np.array([0, 0, self.m * GRAVITY, 0, 0, 0])

    @property
    def held(self) -> Array:
        """Std of the tensions by dry friction at rest, b_c/(√3 R), shape (8,) [N]."""
        return self.b_c / (np.sqrt(3) * self.R)


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


def elastic_robot(
    values: Mapping[str, float], geometry: Geometry, tension: Array, no_load_length: Array
) -> ElasticRobot:
    """Returns the robot of plain values by name, in SI units, where all angles are zero.

    Args:
        values: of all parameters, those of single drives and points included.
        geometry: anchors before the displacements among the values.
        tension: T(0), shape (8,) [N].
        no_load_length: d₀(0), shape (8,) [m].
    """
    names = ("R", "R_s", "k_s", "K_t", "J", "b_v", "b_c", "beta")
    inertia = sum(values[f"I_{axis}"] for axis in "xyz")
    return ElasticRobot(
        geometry=displaced(geometry, values),
        pose=np.array([values[name] for name in ("x", "y", "z", "roll", "pitch", "yaw")]),
        T_0=tension,
        d_0=no_load_length,
        lambda_=at_drives("lambda", values),
        m=values["m"],
        gyration=inertia / (3 * values["m"]),
        **{name: at_drives(name, values) for name in names},
    )


def drum_tension(robot: ElasticRobot, measured: Measured) -> Array:
    """Returns T that balances each drum, shape (N, 8) [N] (thesis 2.39 - 2.41, corrected)."""
    R, R_s, φ, ω = robot.R, robot.R_s, measured.angles, measured.rates
    F_s = np.maximum(0, R / R_s * robot.T_0 - robot.k_s * R_s * φ)
    friction = robot.b_v * ω + robot.b_c * np.tanh(robot.beta * ω)
    return (
        robot.K_t * measured.currents + R_s * F_s - friction - robot.J * measured.rate_changes
    ) / R


def no_load_at_rest(angles: Array, robot: ElasticRobot, T: Array) -> tuple[Array, Array]:
    """Returns d₀ of a measurement and its derivative by T (thesis 2.30, mean strain of both ends).

    Args:
        angles: φ, shape (N, 8) [rad]; the first, so that they can be bound.
        robot: its numbers.
        T: tensions, shape (N, 8) [N].

    Returns:
        d₀ (N, 8) [m], and ∂d₀/∂T (N, 8) [m/N].
    """
    stretch = 1 + (robot.T_0 + T) / (2 * robot.lambda_)
    wound = robot.R * angles / stretch
    return robot.d_0 - wound, wound / stretch / (2 * robot.lambda_)


def no_load_along(robot: ElasticRobot, angles: Array, T: Array) -> Array:
    """Returns d₀ along a log that begins at rest, all angles zero, shape (N, 8) [m] (thesis 2.30).

    Args:
        robot: its numbers.
        angles: φ from sample to sample, shape (N, 8) [rad].
        T: tensions there, shape (N, 8) [N].
    """
    taken = 1 - 1 / (1 + T / robot.lambda_)  # ε/(1 + ε): the part of R dφ that is strain
    first = (1 - 1 / (1 + (robot.T_0 + T[0]) / (2 * robot.lambda_))) * angles[0]
    steps = np.diff(angles, axis=0) * (taken[1:] + taken[:-1]) / 2
    strained = np.concatenate([first[None], first + np.cumsum(steps, axis=0)])
    return robot.d_0 - robot.R * (angles - strained)
