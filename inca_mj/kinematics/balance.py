"""Pose and tensions that agree best with motor angles and currents: weighted least squares.

What angles φ and currents i say of a robot with elastic cables:

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
gives has the std b_c/(√3 R). The tanh of (2.39) has no such rest; the twin creeps until no friction
is left.

Fourteen unknowns, the pose and eight tensions T, and twenty-two statements, each with a std:

    (d(pose) - d₀ (1 + T/λ))/σ_d      8   length of the elastic cable; σ_d = R σ_φ by the encoder
    (T - T_drum)/σ_T                  8   balance of the drum
    (W(pose) T - w)/σ_w               6   balance of the platform, forces and moments

    δ = -(JᵀJ)⁻¹ Jᵀ r,   cov = (JᵀJ)⁻¹          steps of Gauss and Newton; N measurements at once

∂(W T)/∂(v, ω) = -Σ T_i ∂L_iᵀ: the geometric stiffness, whose columns are -L̇ᵀ T for unit twists.
The leverage J (JᵀJ)⁻¹ Jᵀ of a statement says how much of its error the unknowns take; what is left,
one minus that, is its redundancy (eight of twenty-two in all). A slack cable has no tension and
says nothing of the pose: its length counts not, and T is 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.jacobians import jacobian, jacobian_rate
from inca_mj.kinematics.rotations import euler_of, pose_rate_matrix, turn
from inca_mj.robot.elastic import Robot

Array = np.ndarray
STEPS = 40
CLOSE = 1e-9  # largest last step [m, rad]
SLACK = 1e-3  # std of T = 0 in a slack cable [N]
LENGTHS, DRUMS, PLATFORM = slice(0, 8), slice(8, 16), slice(16, 22)
NoLoad = Callable[[Robot, Array], tuple[Array, Array]]


@dataclass(frozen=True, kw_only=True)
class Measured:
    """Measurements at N instants, a row each."""

    angles: Array  # φ, shape (N, 8) [rad]
    currents: Array  # i, shape (N, 8) [A]
    rates: Array  # ω, shape (N, 8) [rad/s]
    rate_changes: Array  # ω̇, shape (N, 8) [rad/s^2]
    rate_noise: float = 0.0  # std of ω̇ that noise of the angles makes, over their std [1/s^2]


@dataclass(frozen=True, kw_only=True)
class Weights:
    """Std of the statements."""

    length: Array  # σ_d of each cable, shape (8,) [m]
    tension: Array  # σ_T of each drum, shape (8,), or (N, 8) where instants differ [N]
    force: float  # of the platform's balance [N]
    moment: float  # of the platform's balance [N m]

    @property
    def platform(self) -> Array:
        """σ_w, shape (6,) [N, N m]."""
        return np.repeat([self.force, self.moment], 3)


@dataclass(frozen=True, kw_only=True)
class Balance:
    """Poses and tensions at N instants."""

    position: Array  # of the platform, shape (N, 3) [m]
    R: Array  # its rotation, shape (N, 3, 3), without unit
    tension: Array  # shape (N, 8) [N]
    taut: Array  # False where a cable is slack, shape (N, 8), bool
    residual: Array  # of the statements, in their std, shape (N, 22), relative
    J: Array  # their derivative by twist and tensions, shape (N, 22, 14), in the units of both
    covariance: Array  # (JᵀJ)⁻¹ of twist and tensions, shape (N, 14, 14), in the units of both

    @property
    def pose(self) -> Array:
        """x, y, z [m], roll, pitch, yaw [rad], shape (N, 6)."""
        return np.hstack([self.position, euler_of(self.R)])

    @property
    def pose_covariance(self) -> Array:
        """Covariance of `pose`, shape (N, 6, 6)."""
        E = pose_rate_matrix(self.pose)
        return E @ self.covariance[:, :6, :6] @ np.swapaxes(E, -1, -2)

    @property
    def redundancy(self) -> Array:
        """Share of each statement's error that is left in its residual, shape (N, 22)."""
        return 1 - np.sum((self.J @ self.covariance) * self.J, axis=2)

    def shift(self, residual_change: Array) -> Array:
        """Returns how pose and tensions move when the residuals change, (N, 22) -> (N, 14).

        The first six are changes of x, y, z, roll, pitch, yaw [m, rad], the others of the tensions
        [N].
        """
        moved = -np.einsum("nij,naj,na->ni", self.covariance, self.J, residual_change)
        moved[:, :6] = np.einsum("nij,nj->ni", pose_rate_matrix(self.pose), moved[:, :6])
        return moved


def balance(
    robot: Robot,
    measured: Measured,
    weights: Weights,
    no_load: NoLoad,
    begin: tuple[Array, Array, Array],
) -> Balance:
    """Returns the most likely poses and tensions.

    `no_load` gives d₀ and ∂d₀/∂T for a robot and tensions; `begin` are positions (N, 3) [m],
    rotations (N, 3, 3) and tensions (N, 8) [N]. Raises InputError if the search does not end, or a
    pose on the way cannot be.
    """
    position, R, T = begin
    taut = np.ones_like(T, dtype=bool)
    for _ in range(2):  # again where a cable turned out to be slack
        position, R, T, covariance = _search(
            robot, measured, weights, no_load, (position, R, T), taut
        )
        now = taut & (T > 0)
        if (now == taut).all():
            break
        taut = now
    r, J = statements(robot, measured, weights, no_load, (position, R, T), taut)
    return Balance(
        position=position, R=R, tension=T, taut=taut, residual=r, J=J, covariance=covariance
    )


def statements(
    robot: Robot,
    measured: Measured,
    weights: Weights,
    no_load: NoLoad,
    at: tuple[Array, Array, Array],
    taut: Array,
) -> tuple[Array, Array]:
    """Returns residuals (N, 22) and their derivatives by twist and T (N, 22, 14), see `balance`."""
    position, R, T = at
    cables = cables_at(position, R, robot.geometry)
    L, stretch = jacobian(cables), 1 + T / robot.lambda_
    d_0, slope = no_load(robot, T)
    σ_T = np.where(taut, weights.tension, SLACK)
    σ_w, eye = weights.platform, np.eye(8)
    WT = -(T[:, None] @ L)[:, 0]
    r = np.concatenate(
        [
            taut * (cables.lengths - d_0 * stretch) / weights.length,
            (T - taut * drum_tension(robot, measured)) / σ_T,
            (WT - robot.weight) / σ_w,
        ],
        axis=1,
    )
    J = np.zeros((len(T), 22, 14))
    J[:, LENGTHS, :6] = (taut / weights.length)[..., None] * L
    by_T = taut * -(d_0 / robot.lambda_ + slope * stretch) / weights.length
    J[:, LENGTHS, 6:] = by_T[..., None] * eye
    J[:, DRUMS, 6:] = eye / σ_T[..., None]
    stiffness = [-(T[:, None] @ jacobian_rate(cables, twist))[:, 0] for twist in np.eye(6)]
    J[:, PLATFORM, :6] = np.stack(stiffness, -1) / σ_w[:, None]
    J[:, PLATFORM, 6:] = -np.swapaxes(L, 1, 2) / σ_w[:, None]
    return r, J


def _search(
    robot: Robot,
    measured: Measured,
    weights: Weights,
    no_load: NoLoad,
    begin: tuple[Array, Array, Array],
    taut: Array,
) -> tuple[Array, Array, Array, Array]:
    position, R, T = begin
    for _ in range(STEPS):
        r, J = statements(robot, measured, weights, no_load, (position, R, T), taut)
        transposed = np.swapaxes(J, -1, -2)
        covariance = np.linalg.inv(transposed @ J)
        step = -(covariance @ (transposed @ r[..., None]))[..., 0]
        position, R, T = position + step[:, :3], turn(step[:, 3:6]) @ R, T + step[:, 6:]
        last = np.abs(step[:, :6]).max(axis=1)
        if last.max() < CLOSE:
            return position, R, T, covariance
    raise InputError(
        f"no pose agrees with the motor angles at sample {int(last.argmax())}; check the geometry,"
        " the pose at the start and the sign of the motor angles (positive winds in)"
    )


def drum_tension(robot: Robot, measured: Measured) -> Array:
    """Returns T that balances each drum, shape (N, 8) [N] (thesis 2.39 - 2.41, corrected)."""
    R, R_s, φ, ω = robot.R, robot.R_s, measured.angles, measured.rates
    F_s = np.maximum(0, R / R_s * robot.tension - robot.k_s * R_s * φ)
    friction = robot.b_v * ω + robot.b_c * np.tanh(robot.beta * ω)
    return (
        robot.K_t * measured.currents + R_s * F_s - friction - robot.J * measured.rate_changes
    ) / R


def no_load_at_rest(angles: Array, robot: Robot, T: Array) -> tuple[Array, Array]:
    """Returns d₀ (N, 8) [m] and ∂d₀/∂T [m/N] of measurements (thesis 2.30, mean strain).

    Angles come first, so that they can be bound.
    """
    stretch = 1 + (robot.tension + T) / (2 * robot.lambda_)
    wound = robot.R * angles / stretch
    return robot.no_load - wound, wound / stretch / (2 * robot.lambda_)


def no_load_along(robot: Robot, angles: Array, T: Array) -> Array:
    """Returns d₀ (N, 8) [m] along a log that begins at rest, all angles zero (thesis 2.30)."""
    taken = 1 - 1 / (1 + T / robot.lambda_)  # ε/(1 + ε): the part of R dφ that is strain
    first = (1 - 1 / (1 + (robot.tension + T[0]) / (2 * robot.lambda_))) * angles[0]
    steps = np.diff(angles, axis=0) * (taken[1:] + taken[:-1]) / 2
    strained = np.concatenate([first[None], first + np.cumsum(steps, axis=0)])
    return robot.no_load - robot.R * (angles - strained)
