"""Estimation by prediction errors of the Kalman predictor, in a few steps of Levenberg-Marquardt.

    min_q  ‖E(q)‖²/σ² + Σ ((q_j - q̄_j)/s_j)²,      E: innovations of e = y - ŷ(q)

A free run of a wrong model drifts, and a fit of it bends the parameters to follow. The predictor's
noise takes part of what is missing for unlogged input errors, at a level that the data choose: the
criterion is tame from afar, and at the truth it is maximum likelihood.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from identification.kalman.noise_fit import Level, fit_noise
from identification.kalman.point import Point, point
from identification.kalman.problem import linearised

NEAR = 0.02  # relative change of the parameters after which the linearisation still holds
ENDED = 0.1  # expected fall of the criterion, in units of the noise, that ends the search
DAMPED = 1e-4  # μ after the first step that failed; the rows' columns have length 1
TRIES = 6  # of a step, each damped ten times as much
PATIENCE = 2  # steps that make the estimate no likelier, after which a search ends
SHORT = 0.5  # of the fall that was expected, below which a step is bent


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
