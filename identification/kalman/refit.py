"""Estimation by prediction errors of the Kalman predictor, in a few steps of Levenberg-Marquardt.

    min_q  ‖E(q)‖²/σ² + Σ ((q_j - q̄_j)/s_j)²,      E: innovations of e = y - ŷ(q)

A free run of a wrong model drifts, and a fit of it bends the parameters to follow. The predictor's
noise takes part of what is missing for unlogged input errors, at a level that the data choose: the
criterion is tame from afar, and at the truth it is maximum likelihood.

Its valleys are narrow and curved (a Stribeck peak and the slope of the smooth sign make up for one
another), so that a straight step that falls short is bent by what the residual does along it
("geodesic acceleration", Transtrum and Sethna 2012):

    q + δ + a,    a = argmin ‖r''(δ)/2 - F a‖² + μ ‖a‖²,    r''(δ) = (r(q + hδ) - r(q) + h F δ) 2/h²
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np
from scipy.optimize import lsq_linear

from identification.errors import DivergenceError
from identification.kalman.noise_fit import Level, fit_noise
from identification.kalman.noise_model import Whitener, whitener
from identification.kalman.point import Point, point

LARGEST = 0.5  # step of a logarithm: parameters change by at most 65 % at a time
NEAR = 0.02  # relative change of the parameters after which the linearisation still holds
ENDED = 0.1  # expected fall of the criterion, in units of the noise, that ends the search
DAMPED = 1e-4  # μ after the first step that failed; the rows' columns have length 1
TRIES = 6  # of a step, each damped ten times as much
PATIENCE = 2  # steps that make the estimate no likelier, after which a search ends
SHORT = 0.5  # of the fall that was expected, below which a step is bent
ALONG = 0.1  # h, of the step


@dataclass(frozen=True)
class Refit:
    """Where the search ended.

    Attributes:
        at: the plant at the estimate.
        level: the noise.
        std: of q, by the likelihood's curvature, shape (p,).
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        steps: taken.
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
        return log_posterior(self.at, self.level, self.mean, self.prior)


def refit(
    at: Point,
    mean: np.ndarray,
    prior: np.ndarray,
    steps: int = 20,
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
    seen = deque(enumerate(islice(descent(at, mean, prior, near), steps + 1)), maxlen=1)
    taken, (end, level) = seen[0]
    return finished(end, level, mean, prior, taken)


def descent(
    at: Point, mean: np.ndarray, prior: np.ndarray, near: Level | None = None
) -> Iterator[tuple[Point, Level]]:
    """The points of a search, each with its noise, from the first to where nothing is gained.

    Args:
        at: where to begin.
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        near: a noise to begin at, where one is known; it is sharpened before the search ends.
    """
    level = noise_at(at, prior, near, fine=False)
    yield at, level
    μ, fine, idle = 0.0, False, 0
    best, most = (at, level), -np.inf
    while idle < PATIENCE:
        problem = linearised(at, level, mean, prior)
        move, fall = problem.step(0.0)
        if fall < ENDED and fine:
            break
        if fall < ENDED:
            level, fine = noise_at(at, prior, level, fine=True), True
            best, most = (at, level), log_posterior(at, level, mean, prior)
            yield at, level
            continue
        for _ in range(TRIES):
            if μ:
                move, fall = problem.step(μ)
            cost = problem.cost(at.q + move)
            if problem.cost_here - cost < SHORT * fall:
                bent = problem.bent(move, μ)
                if (other := problem.cost(at.q + bent)) < cost:
                    move, cost = bent, other
            if cost < problem.cost_here:
                break
            μ = max(10 * μ, DAMPED)
        else:
            break
        μ = μ / 10 if μ > DAMPED else 0.0
        moved = np.abs(move[at.space.logarithmic]).max(initial=0.0)
        at = point(at.predictor, at.space, at.q + move, at.linear if moved < NEAR else None)
        level = noise_at(at, prior, level, fine=False)
        yield at, level
        # Each point has a linearisation and a noise of its own, so that the criterion may rise.
        likely = log_posterior(at, level, mean, prior) if fine else np.inf
        idle = 0 if likely > most + ENDED else idle + 1
        if not fine or likely > most:
            best, most = (at, level), likely if fine else -np.inf
    if best[0] is not at:
        yield best


def log_posterior(at: Point, level: Level, mean: np.ndarray, prior: np.ndarray) -> float:
    """Log likelihood of a point less what the priors hold against it."""
    return level.log_likelihood - 0.5 * float(np.sum(((at.q - mean) * prior) ** 2))


def finished(at: Point, level: Level, mean: np.ndarray, prior: np.ndarray, taken: int) -> Refit:
    """The end of a search."""
    return Refit(at, level, linearised(at, level, mean, prior).std(), mean, prior, taken)


def noise_at(at: Point, prior: np.ndarray, near: Level | None, fine: bool) -> Level:
    """The most likely noise of a point's residual."""
    return fit_noise(at.linear, at.e, at.J, prior, at.log.sampling_time, near, fine)


@dataclass(frozen=True)
class Problem:
    """The criterion about a point: rows of the innovations and of the priors, in units of σ."""

    at: Point
    level: Level
    mean: np.ndarray
    prior: np.ndarray
    filter: Whitener
    rows: np.ndarray
    target: np.ndarray

    @property
    def cost_here(self) -> float:
        """The criterion at the point itself."""
        return float(self.target @ self.target)

    def step(self, μ: float) -> tuple[np.ndarray, float]:
        """The step of Levenberg and Marquardt, and how far the criterion would fall."""
        move = self._least(self.target, μ, np.zeros_like(self.at.q))
        return move, self.cost_here - float(np.sum((self.target - self.rows @ move) ** 2))

    def bent(self, move: np.ndarray, μ: float) -> np.ndarray:
        """A step that follows the residual's curve; the step itself where that leads nowhere."""
        ahead = self.residual(self.at.q + ALONG * move)
        if ahead is None:
            return move
        curve = 2 / ALONG**2 * (ahead - self.target + ALONG * self.rows @ move)
        return move + self._least(curve / 2, μ, move)

    def _least(self, target: np.ndarray, μ: float, begun: np.ndarray) -> np.ndarray:
        """The damped move that leaves the least of a target, where one has begun to move."""
        at, size = self.at, np.where(self.at.space.logarithmic, LARGEST, np.inf)
        lower = np.minimum(np.maximum(at.space.lower - at.q, -size) - begun, 0.0)
        upper = np.maximum(np.minimum(at.space.upper - at.q, size) - begun, 0.0)
        scale = np.linalg.norm(self.rows, axis=0) + 1e-300
        Q, R = np.linalg.qr(self.rows / scale)
        square = np.vstack([R, np.sqrt(μ) * np.eye(len(scale))])
        both = np.concatenate([Q.T @ target, np.zeros(len(scale))])
        bounds = (lower * scale - 1e-12, upper * scale + 1e-12)
        return np.asarray(lsq_linear(square, both, bounds).x / scale)

    def residual(self, q: np.ndarray) -> np.ndarray | None:
        """Rows of the residual elsewhere, by the same filter; None where it cannot be simulated."""
        at = self.at
        try:
            predicted = at.predictor.predict(at.space.decode(at.space.inside(q)))[0]
        except DivergenceError:
            return None
        E = self.filter(at.log.outputs - predicted) / self.level.sigma
        return np.concatenate([E.ravel(), self.prior * (self.mean - q)])

    def cost(self, q: np.ndarray) -> float:
        """The criterion elsewhere; infinite where nothing can be simulated."""
        there = self.residual(q)
        return np.inf if there is None else float(there @ there)

    def std(self) -> np.ndarray:
        """Std of q by the curvature, shape (p,)."""
        covariance = np.linalg.pinv(self.rows.T @ self.rows, rcond=1e-14, hermitian=True)
        return np.sqrt(np.diag(covariance))


def linearised(at: Point, level: Level, mean: np.ndarray, prior: np.ndarray) -> Problem:
    """The criterion about a point."""
    filter_ = whitener(at.linear, level.noise, at.log.sampling_time)
    E, F = filter_(at.e).ravel() / level.sigma, filter_(at.J).reshape(at.e.size, -1) / level.sigma
    rows, target = np.vstack([F, np.diag(prior)]), np.concatenate([E, prior * (mean - at.q)])
    return Problem(at, level, mean, prior, filter_, rows, target)
