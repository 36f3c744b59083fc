"""Estimation by prediction errors of the Kalman predictor, in a few steps of Levenberg-Marquardt.

    min_q  ‖E(q)‖²/σ² + Σ ((q_j - q̄_j)/s_j)²,      E: innovations of e = y - ŷ(q)

A free run of a wrong model drifts, and a fit of it bends the parameters to follow. The predictor's
noise takes part of what is missing for unlogged input errors, at a level that the data choose: the
criterion is tame from afar, and at the truth it is maximum likelihood.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from identification.kalman.innovations import whiteness
from identification.kalman.noise_fit import ALLOWED, Level, fit_noise
from identification.kalman.point import Point, point
from identification.kalman.problem import Problem, linearised

NEAR = 0.02  # relative change of the parameters after which the linearisation still holds
ENDED = 0.1  # expected fall of the criterion, in units of the noise, that ends the search
DAMPED = 1e-4  # μ after the first step that failed; the rows' columns have length 1
TRIES = 6  # of a step, each damped ten times as much
PATIENCE = 2  # steps that gain nothing, after which a search ends
CLOSER = 0.97  # of innovations or a free run, that is a gain while noise is only roughly known
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
        steps: taken to it.
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
        against = float(np.sum(((self.at.q - self.mean) * self.prior) ** 2))
        return self.level.log_likelihood - against / 2


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
    seen = deque(enumerate(descent(at, mean, prior, near, steps)), maxlen=1)
    taken, (end, level) = seen[0]
    return finished(end, level, mean, prior, taken)


def descent(
    at: Point, mean: np.ndarray, prior: np.ndarray, near: Level | None = None, steps: int = 20
) -> Generator[tuple[Point, Level], None, bool]:
    """The points of a search, each with its noise, from the first to the likeliest.

    First the model approaches the data, in likelihood or in its free run, under a noise that is
    only roughly known and no larger than noise is. Then the noise is sharpened, and likelihood
    alone counts, unless it is blind.

    Args:
        at: where to begin.
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        near: a noise to begin at, where one is known.
        steps: at most as many.

    Returns:
        Whether it ended before the steps did.
    """
    believed = ALLOWED * at.motion
    level = noise_at(at, prior, near, largest=believed)
    yield at, level
    for fine in (False, True):
        if fine:
            level = noise_at(at, prior, level, fine)
            yield at, level
        last = at
        problem = linearised(at, level, mean, prior)
        best, most, least = (at, level), problem.log_posterior, _rms(at)
        μ, idle = 0.0, 0
        while steps and idle < PATIENCE and not (fine and _blind(problem)):
            move, μ = _move(problem, μ)
            if move is None:
                break
            steps -= 1
            moved = np.abs(move[at.space.logarithmic]).max(initial=0.0)
            at = point(at.predictor, at.space, at.q + move, at.linear if moved < NEAR else None)
            level = noise_at(at, prior, level, largest=np.inf if fine else believed)
            yield at, level
            last = at
            # Each point has a linearisation and a noise of its own, so that likelihood may fall.
            problem = linearised(at, level, mean, prior)
            likely, off = problem.log_posterior, _rms(at)
            gain = ENDED if fine else -at.e.size * float(np.log(CLOSER))
            better = likely > most + gain or (not fine and off < CLOSER * least)
            if better or likely > most:
                best = at, level
            most, least, idle = max(likely, most), min(off, least), 0 if better else idle + 1
        at, level = best
    if at is not last:
        yield at, level
    return steps > 0


def _blind(problem: Problem) -> bool:
    """Whether the noise explains what it is not: inputs that err too much, and not by chance."""
    at = problem.at
    large = problem.level.input_std > ALLOWED * at.motion
    return large and whiteness(problem.left, at.log.sampling_time).correlated


def _rms(at: Point) -> float:
    """Of the residual of the free run."""
    return float(np.sqrt(np.mean(at.e**2)))


def _move(problem: Problem, μ: float) -> tuple[np.ndarray | None, float]:
    """A step that makes the criterion fall, None where none is left; and the next damping."""
    if problem.step(0.0)[1] < ENDED:
        return None, μ
    for _ in range(TRIES):
        move, fall = problem.step(μ)
        cost = problem.cost(problem.at.q + move)
        if problem.cost_here - cost < SHORT * fall:
            bent = problem.bent(move, μ)
            if (other := problem.cost(problem.at.q + bent)) < cost:
                move, cost = bent, other
        if cost < problem.cost_here:
            return move, μ / 10 if μ > DAMPED else 0.0
        μ = max(10 * μ, DAMPED)
    return None, μ


def finished(at: Point, level: Level, mean: np.ndarray, prior: np.ndarray, taken: int) -> Refit:
    """The end of a search."""
    return Refit(at, level, linearised(at, level, mean, prior).std(), mean, prior, taken)


def noise_at(
    at: Point,
    prior: np.ndarray,
    near: Level | None,
    fine: bool = False,
    largest: float = np.inf,
) -> Level:
    """The most likely noise of a point's residual."""
    Ts = at.log.sampling_time
    return fit_noise(at.linear, at.e, at.J, prior, Ts, near, fine, largest=largest)
