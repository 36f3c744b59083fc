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
from functools import partial
from itertools import islice

import numpy as np

from identification.estimation.levenberg_marquardt import Damping, levenberg_marquardt
from identification.kalman.innovations import innovation_tests
from identification.kalman.noise_fit import ALLOWED, NoiseLevel, fit_noise
from identification.kalman.point import Point, evaluate_point
from identification.kalman.problem import Problem, linearise_criterion

NEAR = 0.02  # relative change of the parameters after which the linearisation still holds
ENDED = 0.1  # expected fall of the criterion, in units of the noise, that ends the search
# first Gauss-Newton's steps; the rows' columns have length 1
DAMPING = Damping(first=0.0, raised=10.0, lowered=10.0, least=1e-4, silent=0.0)
TRIES = 6  # of a step, each damped ten times as much
PATIENCE = 2  # steps that gain nothing, after which a search ends
CLOSER = 0.97  # of innovations or a free run, that is a gain while noise is only roughly known


@dataclass(frozen=True)
class Refit:
    """Where the search ended.

    Attributes:
        point: the plant at the estimate.
        level: the noise.
        std: of q, by the likelihood's curvature, shape (p,).
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        steps: taken to it.
    """

    point: Point
    level: NoiseLevel
    std: np.ndarray
    mean: np.ndarray
    prior: np.ndarray
    steps: int

    @property
    def log_posterior(self) -> float:
        """Log likelihood less what the priors hold against the estimate."""
        against = float(np.sum(((self.point.q - self.mean) * self.prior) ** 2))
        return self.level.log_likelihood - against / 2


def refit(
    point: Point,
    mean: np.ndarray,
    prior: np.ndarray,
    steps: int = 20,
    near: NoiseLevel | None = None,
) -> Refit:
    """Estimate the free parameters of a point, from where it is.

    Args:
        point: where to begin.
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        steps: at most as many.
        near: a noise to begin at, where one is known.
    """
    seen = deque(enumerate(descend(point, mean, prior, near, steps)), maxlen=1)
    taken, (end, level) = seen[0]
    return conclude(end, level, mean, prior, taken)


def descend(
    point: Point,
    mean: np.ndarray,
    prior: np.ndarray,
    near: NoiseLevel | None = None,
    steps: int = 20,
) -> Generator[tuple[Point, NoiseLevel], None, bool]:
    """The points of a search, each with its noise, from the first to the likeliest.

    First the model approaches the data, in likelihood or in its free run, under a noise that is
    only roughly known and no larger than noise is. Then the noise is sharpened, and likelihood
    alone counts, unless it is blind.

    Args:
        point: where to begin.
        mean: q̄ of the priors, shape (p,).
        prior: 1/std of each prior, zero where there is none, shape (p,).
        near: a noise to begin at, where one is known.
        steps: at most as many.

    Returns:
        Whether it ended before the steps did.
    """
    believed = ALLOWED * point.motion
    level = estimate_noise(point, prior, near, largest=believed)
    yield point, level
    for fine in (False, True):
        if fine:
            level = estimate_noise(point, prior, level, fine)
            yield point, level
        last, largest = point, np.inf if fine else believed
        problem = linearise_criterion(point, level, mean, prior)
        best, most, least, idle = (point, level), problem.log_posterior, _rms(point), 0
        trials = levenberg_marquardt(problem, partial(_moved, largest=largest), DAMPING)
        while steps and idle < PATIENCE and not (fine and _blind(problem)):
            if problem.promised(problem.step(0.0)) < ENDED:
                break
            trial = next((t for t in islice(trials, TRIES) if t.taken), None)
            if trial is None:
                break
            problem, steps = trial.criterion, steps - 1
            last = point = problem.point
            level = problem.level
            yield point, level
            # Each point has a linearisation and a noise of its own, so that likelihood may fall.
            likely, off = problem.log_posterior, _rms(point)
            gain = ENDED if fine else -point.e.size * float(np.log(CLOSER))
            better = likely > most + gain or (not fine and off < CLOSER * least)
            if better or likely > most:
                best = point, level
            most, least, idle = max(likely, most), min(off, least), 0 if better else idle + 1
        point, level = best
    if point is not last:
        yield point, level
    return steps > 0


def _moved(problem: Problem, step: np.ndarray, taken: np.ndarray, largest: float) -> Problem:
    """Simulated after a step, with a noise of its own, and linearised."""
    point = problem.point
    small = np.abs(step[point.space.logarithmic]).max(initial=0.0) < NEAR
    linear = point.linear if small else None
    point = evaluate_point(point.predictor, point.space, point.q + step, linear)
    level = estimate_noise(point, problem.prior, problem.level, largest=largest)
    return linearise_criterion(point, level, problem.mean, problem.prior)


def _blind(problem: Problem) -> bool:
    """Whether the noise explains what it is not: inputs that err too much, and not by chance."""
    point = problem.point
    large = problem.level.input_std > ALLOWED * point.motion
    return large and innovation_tests(problem.left, point.log.sampling_time).correlated


def _rms(point: Point) -> float:
    """Of the residual of the free run."""
    return float(np.sqrt(np.mean(point.e**2)))


def conclude(
    point: Point, level: NoiseLevel, mean: np.ndarray, prior: np.ndarray, taken: int
) -> Refit:
    """The end of a search."""
    return Refit(
        point, level, linearise_criterion(point, level, mean, prior).std(), mean, prior, taken
    )


def estimate_noise(
    point: Point,
    prior: np.ndarray,
    near: NoiseLevel | None,
    fine: bool = False,
    largest: float = np.inf,
) -> NoiseLevel:
    """The most likely noise of a point's residual."""
    Ts = point.log.sampling_time
    return fit_noise(point.linear, point.e, point.J, prior, Ts, near, fine, largest=largest)
