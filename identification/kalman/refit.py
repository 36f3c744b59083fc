"""Estimation by prediction errors of the Kalman predictor, in a few steps of Levenberg-Marquardt.

    min_q  ‖E(q)‖²/σ² + Σ ((q_j - q̄_j)/s_j)²,      E: innovations of e = y - ŷ(q)

A free run of a wrong model drifts away from the data, and a fit of the free run bends the
parameters until it follows. The noise model of the Kalman predictor takes a part of what is missing
for unlogged errors of the inputs, at a level that is estimated. The criterion is therefore smooth
far from the truth, and at the truth it is that of maximum likelihood.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from identification.estimation.levenberg_marquardt import Damping, levenberg_marquardt
from identification.estimation.priors import Priors
from identification.estimation.residuals import innovation_tests
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.options import KalmanOptions
from identification.kalman.point import Point, evaluate_point
from identification.kalman.problem import (
    Problem,
    estimate_noise,
    linearise_criterion,
    share_out,
)
from identification.model.predictor import Plant
from identification.runtime.progress import Progress, counted

# Expected fall of the criterion for each parameter, in units of the noise, below which a search
# ends: the parameters are then, as a root mean square, within a tenth of their std of the optimum.
END_FALL = 0.01
# The same of the first part of a search, which only comes near: within a third.
APPROACH_END_FALL = 0.1
# Gauss-Newton steps until one fails; the columns of the rows are scaled to length 1
DAMPING = Damping(first=0.0, raised=10.0, least=1e-4)
MAX_ATTEMPTS = 6  # at a step, each damped ten times as much as the one before
MAX_BORROWED_ATTEMPTS = 2  # where columns are borrowed, which are then computed anew
# While the noise is only roughly known, a step makes progress if it brings the rms of the
# innovations or of the free run below this share of the best one.
PROGRESS_SHARE = 0.97
PATIENCE = 2  # successive steps without progress after which a search ends


@dataclass(frozen=True, kw_only=True, eq=False)
class Refit:
    """The estimate at which a search ended."""

    point: Point  # the plant at the estimate
    level: NoiseLevel  # the noise
    std: np.ndarray  # of q, by the curvature of the likelihood, shape (p,)
    priors: Priors  # what was known of the parameters
    steps: int  # number of steps that were taken

    @property
    def log_posterior(self) -> float:
        """Log likelihood plus log density of the priors, up to a constant."""
        return _posterior(self.point, self.level, self.priors)

    @property
    def problem(self) -> Problem:
        """The criterion, linearised about the estimate."""
        return linearise_criterion(self.point, self.level, self.priors)

    @property
    def plant(self) -> Plant:
        """The plant with its own values."""
        return self.point.predictor.plant

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters that are not the plant's own, by name, in their units."""
        return self.point.values

    told_values = values

    @property
    def own_values(self) -> dict[str, dict[str, float]]:
        """No record has values that the others have not."""
        return {}

    @property
    def told_std(self) -> dict[str, float]:
        """Std of the free parameters by name, in their units; NaN at a bound."""
        space, q = self.point.space, self.point.q
        std = np.where(space.on_bound(q), np.nan, self.std * space.slope(q))
        return dict(zip(space.names, std.tolist(), strict=True))

    @property
    def at_bound(self) -> tuple[str, ...]:
        """Names of the free parameters that lie on a bound of the search."""
        space = self.point.space
        on_bound = space.on_bound(self.point.q)
        return tuple(n for n, at in zip(space.names, on_bound, strict=True) if at)

    @property
    def unlearned(self) -> dict[str, float]:
        """Std of each free parameter over the std that was known before; 0 where none was."""
        shares = (self.std * self.priors.weight).tolist()
        return dict(zip(self.point.space.names, shares, strict=True))

    @property
    def departures(self) -> dict[str, float]:
        """Change of each free value since before the fit, in std of what was known; 0 without."""
        moved = (-self.priors.against(self.point.q)).tolist()
        return dict(zip(self.point.space.names, moved, strict=True))

    @property
    def finer(self) -> None:
        """The change of the fit with finer steps, for which nobody asks along a free run."""
        return None

    @property
    def relative_input_error(self) -> float:
        """Std of the inputs' error in the noise model, as a share of the inputs' own motion."""
        moved = self.point.motion
        return self.level.input_std / moved if moved > 0 else 0.0


def refit(
    point: Point,
    priors: Priors,
    options: KalmanOptions,
    steps: int = 20,
    near: NoiseLevel | None = None,
    progress: Progress | None = None,
    is_near: bool = False,
    least: float = -np.inf,
) -> Refit:
    """Estimate the free parameters of a point, beginning where it is.

    Args:
        point: where to begin.
        priors: what is known of the parameters.
        options: which noise is believed.
        steps: largest number of steps.
        near: a noise to begin at, where one is known.
        progress: is told one line per step.
        is_near: whether the point is near the optimum, so that only the likelihood counts.
        least: log posterior that an estimate must come to, to matter.
    """
    search = descend(point, priors, options, near, steps, is_near, least)
    for step in enumerate(counted(search, "steps of a fit")):
        taken, (end, level) = step
        if progress is not None:
            off = float(np.sqrt(np.mean(end.e**2)))
            progress(f"step {taken}: free run {off:.3g}, sensors {level.sigma:.3g} rms")
    return conclude(end, level, priors, taken)


def descend(
    point: Point,
    priors: Priors,
    options: KalmanOptions,
    near: NoiseLevel | None = None,
    steps: int = 20,
    is_near: bool = False,
    least: float = -np.inf,
) -> Generator[tuple[Point, NoiseLevel], None, bool]:
    """Yields the points of a search, each with its noise, from the first to the likeliest.

    First the model approaches the data: a step counts as progress when likelihood or free run
    improve, under a noise that is chosen from a grid and bounded by `options.allowed_input_error`.
    Then the noise is refined without that bound and shared out among the sensors, and only the
    likelihood counts. This second part is left out where the refined noise exceeds the bound and
    its innovations are not white; it ends where a point, after the best small change of its
    parameters, stays below `least`.

    Returns:
        Whether the search ended before it had used all steps.
    """
    believed = np.inf if is_near else largest_input_error(point, options)
    level = estimate_noise(point, priors, near, largest=believed)
    yield point, level
    for fine in (True,) if is_near else (False, True):
        ended = (END_FALL if fine else APPROACH_END_FALL) * len(point.q)
        if fine:
            level = estimate_noise(point, priors, level, fine)
            yield point, level
        last, largest = point, np.inf if fine else believed
        problem = linearise_criterion(point, level, priors, largest)
        best, most, nearest, idle = (point, level), problem.log_posterior, _rms(point), 0
        trials = levenberg_marquardt(problem, DAMPING)
        while steps and idle < PATIENCE and not (fine and _is_refuted(problem, options)):
            if problem.expected_fall(problem.step(0.0)) < ended:
                break
            if fine and _posterior(point, level, priors) < least:
                break
            tries = MAX_BORROWED_ATTEMPTS if point.is_borrowed else MAX_ATTEMPTS
            trial = next((t for t in islice(trials, tries) if t.taken), None)
            if trial is None and point.is_borrowed:
                point = evaluate_point(point.predictor, point.space, point.q, None, point.small)
                problem = linearise_criterion(point, level, priors, largest)
                trials = levenberg_marquardt(problem, DAMPING)
                continue
            if trial is None:
                break
            problem, steps = trial.criterion, steps - 1
            last = point = problem.point
            level = problem.level
            yield point, level
            # Every point has its own linearisation and noise, so the likelihood may also fall.
            likely, off = problem.log_posterior, _rms(point)
            gain = ended if fine else -point.e.size * float(np.log(PROGRESS_SHARE))
            better = likely > most + gain or (not fine and off < PROGRESS_SHARE * nearest)
            if better or likely > most:
                best = point, level
            most, nearest, idle = max(likely, most), min(off, nearest), 0 if better else idle + 1
        point, level = best
    shared = share_out(point, priors, level)  # what the last steps explain is no noise
    if point is not last or shared is not level:
        yield point, shared
    return steps > 0


def _posterior(point: Point, level: NoiseLevel, priors: Priors) -> float:
    """Returns the log likelihood plus the log density of the priors, up to a constant."""
    return level.log_likelihood - float(np.sum(priors.against(point.q) ** 2)) / 2


def _is_refuted(problem: Problem, options: KalmanOptions) -> bool:
    """Returns whether the noise model is wrong here: its input error is too large and not random.

    Its likelihood is then no guide.
    """
    point = problem.point
    if problem.level.input_std <= largest_input_error(point, options):
        return False
    white = innovation_tests(problem.remaining_innovations, point.log.sampling_time)
    return white.is_correlated(options.structure_level, options.min_structure_share)


def largest_input_error(point: Point, options: KalmanOptions) -> float:
    """Returns the largest error of the inputs that is believed, in the inputs' unit.

    Where no input moves there is nothing to compare it with, and any is believed.
    """
    return options.allowed_input_error * point.motion if point.motion > 0 else np.inf


def _rms(point: Point) -> float:
    """Returns the rms of the residual of the free run."""
    return float(np.sqrt(np.mean(point.e**2)))


def conclude(point: Point, level: NoiseLevel, priors: Priors, taken: int) -> Refit:
    """Returns the estimate at the point where a search ended after `taken` steps."""
    std = linearise_criterion(point, level, priors).std()
    return Refit(point=point, level=level, std=std, priors=priors, steps=taken)
