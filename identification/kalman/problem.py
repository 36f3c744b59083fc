"""The criterion about a point, linearised, and its damped steps, for `levenberg_marquardt`.

    min_δ ‖r + F δ‖² + μ ‖δ‖²,    r: innovations over σ, and the priors

Its valleys are narrow and curved (a Stribeck peak and the slope of the smooth sign make up for one
another), so that a straight step that falls short is bent by what the residual does along it
("geodesic acceleration", Transtrum and Sethna 2012):

    q + δ + a,    a = argmin ‖r''(δ)/2 - F a‖² + μ ‖a‖²,    r''(δ) = (r(q + hδ) - r(q) + h F δ) 2/h²
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from identification.errors import DivergenceError, InputError
from identification.estimation.levenberg_marquardt import Cost
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Whitener, build_whitener
from identification.kalman.point import Point

LARGEST = 0.5  # step of a logarithm: parameters change by at most 65 % at a time
ALONG = 0.1  # h, of the step
SHORT = 0.5  # of the fall that a step promised, below which it is bent


@dataclass(frozen=True)
class Problem:
    """The criterion about a point: rows of the innovations and of the priors, in units of σ."""

    point: Point
    level: NoiseLevel
    mean: np.ndarray
    prior: np.ndarray
    filter: Whitener
    rows: np.ndarray
    target: np.ndarray

    @property
    def cost(self) -> float:
        """The criterion at the point itself."""
        return float(self.target @ self.target)

    @property
    def log_posterior(self) -> float:
        """Of the point as it is, where that of its noise lets the parameters move a little."""
        return self.level.log_likelihood - self.cost / 2

    @property
    def left(self) -> np.ndarray:
        """Innovations that the best small change of the parameters would leave, shape (N, ny)."""
        left = self.target - self.rows @ self.step(0.0)
        return left[: self.point.e.size].reshape(self.point.e.shape)

    def step(self, μ: Cost) -> np.ndarray:
        """The step of Levenberg and Marquardt, inside the bounds."""
        return self._least(self.target, μ, np.zeros_like(self.point.q))

    def promised(self, move: np.ndarray) -> float:
        """How far the criterion would fall by a step, were it straight."""
        return self.cost - float(np.sum((self.target - self.rows @ move) ** 2))

    def bent(self, move: np.ndarray, after: Cost, μ: Cost) -> np.ndarray | None:
        """A step that follows the residual's curve, where the straight one falls short."""
        if self.cost - after >= SHORT * self.promised(move):
            return None
        ahead = self.residual(self.point.q + ALONG * move)
        if ahead is None:
            return None
        curve = 2 / ALONG**2 * (ahead - self.target + ALONG * self.rows @ move)
        return move + self._least(curve / 2, μ, move)

    def _least(self, target: np.ndarray, μ: Cost, begun: np.ndarray) -> np.ndarray:
        """The damped move that leaves the least of a target, where one has begun to move."""
        point, size = self.point, np.where(self.point.space.logarithmic, LARGEST, np.inf)
        lower = np.minimum(np.maximum(point.space.lower - point.q, -size) - begun, 0.0)
        upper = np.maximum(np.minimum(point.space.upper - point.q, size) - begun, 0.0)
        scale = np.linalg.norm(self.rows, axis=0) + 1e-300
        Q, R = np.linalg.qr(self.rows / scale)
        square = np.vstack([R, np.sqrt(μ) * np.eye(len(scale))])
        both = np.concatenate([Q.T @ target, np.zeros(len(scale))])
        bounds = (lower * scale - 1e-12, upper * scale + 1e-12)
        return np.asarray(lsq_linear(square, both, bounds).x / scale)

    def residual(self, q: np.ndarray) -> np.ndarray | None:
        """Rows of the residual elsewhere, by the same filter; None where it cannot be simulated."""
        point = self.point
        try:
            predicted = point.predictor.predict(point.space.decode(point.space.inside(q)))[0]
        except (DivergenceError, InputError):  # or a start that cannot stand
            return None
        E = self.filter(point.log.outputs - predicted) / self.level.sigma
        return np.concatenate([E.ravel(), self.prior * (self.mean - q)])

    def cost_after(self, move: np.ndarray) -> float:
        """The criterion after a step; infinite where nothing can be simulated."""
        there = self.residual(self.point.q + move)
        return np.inf if there is None else float(there @ there)

    def std(self) -> np.ndarray:
        """Std of q by the curvature, shape (p,)."""
        covariance = np.linalg.pinv(self.rows.T @ self.rows, rcond=1e-14, hermitian=True)
        return np.sqrt(np.diag(covariance))


def linearise_criterion(
    point: Point, level: NoiseLevel, mean: np.ndarray, prior: np.ndarray
) -> Problem:
    """The criterion about a point."""
    filter_ = build_whitener(point.linear, level.noise, point.log.sampling_time)
    E, F = (
        filter_(point.e).ravel() / level.sigma,
        filter_(point.J).reshape(point.e.size, -1) / level.sigma,
    )
    rows, target = np.vstack([F, np.diag(prior)]), np.concatenate([E, prior * (mean - point.q)])
    return Problem(point, level, mean, prior, filter_, rows, target)
