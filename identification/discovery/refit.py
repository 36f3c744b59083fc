"""Estimation by prediction errors of the Kalman predictor, in a few Gauss-Newton steps.

    min_q  ‖E(q)‖²/σ² + Σ ((q_j - q̄_j)/s_j)²,      E: innovations of e = y - ŷ(q)

A free run of a wrong model drifts, and a fit of it bends the parameters to follow. The predictor's
noise takes part of what is missing for unlogged input errors, at a level that the data choose: the
criterion is tame from afar, and at the truth it is maximum likelihood.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from identification.discovery.noise_fit import Level, fit_noise
from identification.discovery.noise_model import whitener
from identification.discovery.point import Point, point
from identification.errors import DivergenceError

LARGEST = 0.5  # step of a logarithm: parameters change by at most 65 % at a time
NEAR = 0.02  # relative change of the parameters after which the linearisation still holds
ENDED = 1.0  # expected fall of the criterion, in units of the noise, that ends the search


@dataclass(frozen=True)
class Refit:
    """Where the search ended.

    Attributes:
        at: the plant at the estimate.
        level: the noise.
        std: of q, by the likelihood's curvature, shape (p,).
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        steps: Gauss-Newton steps taken.
    """

    at: Point
    level: Level
    std: np.ndarray
    mean: np.ndarray
    prior: np.ndarray
    steps: int

    @property
    def log_posterior(self) -> float:
        """Log likelihood less what the priors hold against the estimate."""
        return self.level.log_likelihood - 0.5 * float(
            np.sum(((self.at.q - self.mean) * self.prior) ** 2)
        )


def refit(
    at: Point,
    mean: np.ndarray,
    prior: np.ndarray,
    steps: int = 10,
    near: Level | None = None,
) -> Refit:
    """Estimate the free parameters of a point, from where it is.

    Args:
        at: where to begin.
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        steps: at most as many.
        near: a noise to begin at, where one is known.
    """

    def noise(at: Point, near: Level | None, fine: bool) -> Level:
        return fit_noise(at.linear, at.e, at.J, prior, at.log.sampling_time, near, fine)

    level = noise(at, near, fine=False)
    for k in range(steps):
        move, fall, std = _step(at, level, mean, prior)
        if fall < ENDED:
            return Refit(at, noise(at, level, fine=True), std, mean, prior, k)
        moved = np.abs(move[at.space.logarithmic]).max(initial=0.0)
        linear = at.linear if moved < NEAR else None
        try:
            new = point(at.predictor, at.space, at.q + move, linear)
        except DivergenceError:
            new = point(at.predictor, at.space, at.q + move / 4, linear)
        at, level = new, noise(new, level, fine=False)
    level = noise(at, level, fine=True)
    return Refit(at, level, _step(at, level, mean, prior)[2], mean, prior, steps)


def _step(
    at: Point, level: Level, mean: np.ndarray, prior: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray]:
    """The Gauss-Newton step, how far the criterion would fall, and the std of q."""
    filter_ = whitener(at.linear, level.noise, at.log.sampling_time)
    E, F = filter_(at.e).ravel() / level.sigma, filter_(at.J).reshape(at.e.size, -1) / level.sigma
    rows = np.vstack([F, np.diag(prior)])
    target = np.concatenate([E, prior * (mean - at.q)])
    size = np.where(at.space.logarithmic, LARGEST, np.inf)
    lower = np.maximum(at.space.lower - at.q, -size)
    upper = np.minimum(at.space.upper - at.q, size)
    scale = np.linalg.norm(rows, axis=0) + 1e-300
    Q, R = np.linalg.qr(rows / scale)
    move = lsq_linear(R, Q.T @ target, (lower * scale - 1e-12, upper * scale + 1e-12)).x / scale
    fall = float(target @ target - np.sum((target - rows @ move) ** 2))
    covariance = np.linalg.pinv(rows.T @ rows, rcond=1e-14, hermitian=True)
    return move, fall, np.sqrt(np.diag(covariance))
