"""The criterion of a fit, linearised about a point, with the steps of `levenberg_marquardt`.

    min_δ ‖r + F δ‖² + μ ‖δ‖²,    r: innovations over σ, and the priors

The valleys of the criterion are narrow and curved: a Stribeck peak and the slope of the smooth sign
compensate each other. A straight step whose gain is less than expected is therefore bent along the
second derivative of the residual ("geodesic acceleration", Transtrum and Sethna 2012):

    q + δ + a,    a = argmin ‖r''(δ)/2 - F a‖² + μ ‖a‖²,    r''(δ) = (r(q + hδ) - r(q) + h F δ) 2/h²
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular
from scipy.optimize import lsq_linear

from identification.errors import DivergenceError, InputError
from identification.estimation.levenberg_marquardt import KEPT_GAIN, SLOPE_ERROR, Cost, Criterion
from identification.estimation.metrics import output_units
from identification.estimation.priors import Priors, estimate_scatter
from identification.kalman.noise_fit import NoiseLevel, evaluate_noise, fit_noise, share_level
from identification.kalman.noise_model import Whitener, keep, whiten
from identification.kalman.point import Point, evaluate_point, is_costly, shift_point
from identification.kalman.trajectory import Run

MAX_LOG_STEP = 0.5  # a parameter changes by at most 65 % at a time
BEND_STEP = 0.1  # h: the share of the step at which the second derivative is taken
# Condition of the columns up to which their products are taken in place of themselves: the products
# lose 1e-16 MAX_CONDITION² of a step, far less than the columns, which are differences, are off.
MAX_CONDITION = 1e5
# Relative change of the parameters after which columns and linearisation may still hold.
SHORT_CHANGE = 0.02


@dataclass(frozen=True, kw_only=True)
class Problem(Criterion[np.ndarray]):
    """The criterion about a point: rows of the innovations and of the priors, in units of σ."""

    point: Point  # the plant at the point, with p free parameters
    level: NoiseLevel  # the noise
    priors: Priors  # what is known of the parameters
    filter: Whitener  # the whitening filter of the noise
    rows: np.ndarray  # F, shape (N ny + p, p)
    target: np.ndarray  # -r, shape (N ny + p,)
    curvature: np.ndarray  # FᵀF, shape (p, p)
    # largest error of the inputs that is believed after a step, in the inputs' unit
    largest: float = np.inf
    # simulations after steps that were tried, by the bytes of their q
    runs: dict[bytes, Run] = field(default_factory=dict, repr=False)

    @property
    def cost(self) -> float:
        """The value of the criterion at the point."""
        return float(self.target @ self.target)

    @property
    def log_posterior(self) -> float:
        """Log posterior of the point itself, up to a constant.

        `level.log_likelihood` is that after a small change of the parameters.
        """
        return self.level.log_likelihood - self.cost / 2

    @property
    def remaining_innovations(self) -> np.ndarray:
        """Innovations after the best small change of the parameters, shape (N, ny)."""
        remaining = self.target - self.rows @ self.step(0.0)
        return remaining[: self.point.e.size].reshape(self.point.e.shape)

    def step(self, μ: Cost) -> np.ndarray:
        """Returns the Levenberg-Marquardt step within the bounds, shape (p,)."""
        return self._least(self.target, μ, np.zeros_like(self.point.q))

    def expected_fall(self, move: np.ndarray) -> float:
        """Returns how far a step would lower the criterion if the residual were linear."""
        return self.cost - float(np.sum((self.target - self.rows @ move) ** 2))

    def bend(self, move: np.ndarray, after: Cost, μ: Cost) -> np.ndarray | None:
        """Returns the step with its second-order correction, shape (p,).

        None where the step itself falls far enough, or the plant cannot be simulated along it.
        """
        if self.cost - after >= KEPT_GAIN * self.expected_fall(move):
            return None
        ahead = self.residual(self.point.q + BEND_STEP * move)
        if ahead is None:
            return None
        curve = 2 / BEND_STEP**2 * (ahead - self.target + BEND_STEP * self.rows @ move)
        return move + self._least(curve / 2, μ, move)

    def _least(self, target: np.ndarray, μ: Cost, taken: np.ndarray) -> np.ndarray:
        """Returns the damped δ that minimises ‖target - F δ‖, within bounds after `taken`."""
        point, size = self.point, np.where(self.point.space.logarithmic, MAX_LOG_STEP, np.inf)
        lower = np.minimum(np.maximum(point.space.lower - point.q, -size) - taken, 0.0)
        upper = np.maximum(np.minimum(point.space.upper - point.q, size) - taken, 0.0)
        scale, R, Q = self._factor
        if Q is None:
            along = solve_triangular(R, self.rows.T @ target / scale, trans=1)
        else:
            along = Q.T @ target
        square = np.vstack([R, np.sqrt(μ) * np.eye(len(scale))])
        both = np.concatenate([along, np.zeros(len(scale))])
        bounds = (lower * scale - 1e-12, upper * scale + 1e-12)
        return np.asarray(lsq_linear(square, both, bounds).x / scale)

    @cached_property
    def _factor(self) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
        """Lengths of the columns of F, R and Q of F with columns of length 1; Q may be left out.

        The normal equations give R where they lose no digit that matters.
        """
        scale = np.sqrt(np.diag(self.curvature)) + 1e-300
        try:
            R = np.linalg.cholesky(self.curvature / np.outer(scale, scale)).T
            if np.linalg.cond(R) < MAX_CONDITION:
                return scale, R, None
        except np.linalg.LinAlgError:
            pass
        Q, R = np.linalg.qr(self.rows / scale)
        return scale, R, Q

    def run_at(self, q: np.ndarray) -> Run:
        """Returns the simulation at another q, one for all who ask for it."""
        point = self.point
        new = Run(point.predictor, point.space.decode(point.space.inside(q)))
        return self.runs.setdefault(q.tobytes(), new)

    def residual(self, q: np.ndarray) -> np.ndarray | None:
        """Returns -r at another q and the same filter, shape (N ny + p,); None if it diverges."""
        try:
            predicted = self.run_at(q).outputs
        except (DivergenceError, InputError):  # InputError: the robot cannot rest at its start
            return None
        E = self.filter(self.point.log.outputs - predicted) / self.level.sigma
        return np.concatenate([E.ravel(), self.priors.against(q)])

    def cost_after(self, move: np.ndarray) -> float:
        """Returns the criterion after a step; infinite where the plant cannot be simulated."""
        after = self.residual(self.point.q + move)
        return np.inf if after is None else float(after @ after)

    def moved(self, move: np.ndarray, taken: np.ndarray) -> Problem:
        """Returns the criterion about the point after a step, with the noise of that point."""
        point = self.point
        change = np.abs(move[point.space.logarithmic]).max(initial=0.0)
        is_short = change < SHORT_CHANGE and is_costly(point)
        q = point.q + move
        run = self.run_at(q)
        new = shift_point(point, q, run) if is_short else None
        if new is None:
            # Columns of small parameters change by about as much as the others do.
            near = point if change < SLOPE_ERROR else None
            new = evaluate_point(point.predictor, point.space, q, near, point.small, run)
        level = estimate_noise(new, self.priors, self.level, largest=self.largest)
        return linearise_criterion(new, level, self.priors, self.largest)

    def scatter(self, groups: Mapping[str, Sequence[str]]) -> dict[str, float]:
        """Returns the most probable std of the prior of each group of parameters, by group."""
        F, y = self.rows[: self.point.e.size], self.target[: self.point.e.size]
        return estimate_scatter(self.priors, self.point.q, F, y, groups)

    @property
    def covariance(self) -> np.ndarray:
        """The covariance of q by the curvature of the criterion, shape (p, p)."""
        return np.linalg.pinv(self.curvature, rcond=1e-14, hermitian=True)

    def std(self) -> np.ndarray:
        """Returns the std of q by the curvature of the criterion, shape (p,)."""
        return np.sqrt(np.diag(self.covariance))


def linearise_criterion(
    point: Point, level: NoiseLevel, priors: Priors, largest: float = np.inf
) -> Problem:
    """Returns the criterion under a noise and priors, linearised about a point; see `Problem`."""
    white = whiten(point.linear, point.J, level.noise, point.log.sampling_time)
    keep(white)
    E = white.filter(point.e).ravel() / level.sigma
    rows = np.vstack([white.F / level.sigma, priors.rows])
    target = np.concatenate([E, priors.against(point.q)])
    return Problem(
        point=point, level=level, priors=priors, filter=white.filter, rows=rows,
        target=target, curvature=white.H / level.sigma**2 + np.diag(priors.weight**2),
        largest=largest,
    )  # fmt: skip


def estimate_noise(
    point: Point,
    priors: Priors,
    near: NoiseLevel | None,
    fine: bool = False,
    largest: float = np.inf,
) -> NoiseLevel:
    """Returns the most likely noise of a point's residual; see `fit_noise`."""
    linear, e, J, Ts = point.linear, point.e, point.J, point.log.sampling_time
    kinds = [*output_units(point.log).values()] if fine else ()
    return fit_noise(linear, e, J, priors.weight, Ts, near, fine, largest=largest, kinds=kinds)


def share_out(point: Point, priors: Priors, level: NoiseLevel) -> NoiseLevel:
    """Returns the level of a point's residual with its likeliest shares; see `noise_shares`."""
    e, Ts = point.e, point.log.sampling_time
    if e.shape[1] == 1:
        return level
    known = whiten(point.linear, point.J, level.noise, Ts)
    kinds = [*output_units(point.log).values()]
    noise = share_level(known, e, priors.weight, Ts, kinds)
    white = whiten(point.linear, point.J, noise, Ts)
    shared = evaluate_noise(white, e, priors.weight)
    if shared.log_likelihood <= level.log_likelihood:
        return level
    keep(white)
    return shared
