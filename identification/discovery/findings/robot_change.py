"""Does what was fitted hold on the other samples? A robot may change, or show more of itself.

    δ = argmin ‖E - F δ‖² + Σ ((q_j + δ_j - q̄_j)/s_j)²        over all samples, F = ∂E/∂q

Parameters that a fit knows only roughly predict other samples only roughly; what a small change of
them does not take away from the innovations there is no uncertainty of theirs.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import ttest_ind
from threadpoolctl import threadpool_limits

from identification.discovery.fitted_model import FittedModel
from identification.discovery.proof import BLOCKS, Validation
from identification.errors import DivergenceError
from identification.kalman.innovations import MATTERS, SURE
from identification.kalman.point import evaluate_sensitivities


def find_robot_change(step: FittedModel) -> tuple[str, ...]:
    """A sentence where the unseen samples are farther off than the fitted ones, beyond chance.

    Args:
        step: a fitted model, seen on the whole log.
    """
    seen, first = step.validation, step.validation.first
    fitted, E = seen.innovations[:first], seen.innovations
    if not _louder(fitted, E[first:]):
        return ()
    try:
        left = E - _taken(seen)
    except DivergenceError:  # where a parameter that is moved a little loses the robot
        left = E
    if not _louder(fitted, left[first:]):
        return ()
    log, ratio = seen.refit.point.log, _power(left[first:]).mean() / _power(fitted).mean()
    at = log.time[-1] + log.sampling_time * (1 + _onset(_power(fitted), _power(left[first:])))
    return (
        f"samples that were not fitted, which a predictor of the next sample misses by"
        f" {np.sqrt(ratio):.3g} times as much as those that were, from about {at:.3g} s on: the"
        " robot changed, or does there what the fitted part never shows",
    )


def _onset(fitted: np.ndarray, unseen: np.ndarray) -> int:
    """First sample of the unseen ones from which on they differ the most from all before."""
    ends = np.array_split(np.arange(len(unseen)), BLOCKS)
    a, b = np.log(_blocks(fitted)), np.log(_blocks(unseen))

    def apart(k: int) -> float:
        before, after = np.concatenate([a, b[:k]]), b[k:]
        n, m = len(before), len(after)
        return float((after.mean() - before.mean()) * np.sqrt(n * m / (n + m)))

    return int(ends[max(range(BLOCKS), key=apart)][0])


def _blocks(power: np.ndarray) -> np.ndarray:
    return np.array([part.mean() for part in np.array_split(power, BLOCKS)])


def _power(E: np.ndarray) -> np.ndarray:
    return np.mean(E**2, axis=1)


def _louder(fitted: np.ndarray, unseen: np.ndarray) -> bool:
    """Whether unseen innovations are larger, beyond chance and by enough to matter."""
    a, b = _blocks(_power(fitted)), _blocks(_power(unseen))
    # logarithms, as a few blocks far off would be scatter and no difference
    p = ttest_ind(np.log(b), np.log(a), equal_var=False, alternative="greater").pvalue
    return bool(p < SURE and b.mean() > (1 + MATTERS) * a.mean())


def _taken(seen: Validation) -> np.ndarray:
    """What a small change of the parameters takes from the innovations of all samples, (N, ny)."""
    fit = seen.refit
    with threadpool_limits(1, "blas"):
        J = evaluate_sensitivities(fit.point, seen.whole)
        F = seen.filter(J).reshape(seen.e.size, -1) / fit.level.sigma
        rows = np.vstack([F, np.diag(fit.prior)])
        target = np.concatenate([seen.innovations.ravel(), fit.prior * (fit.mean - fit.point.q)])
        scale = np.linalg.norm(rows, axis=0) + 1e-300
        move = np.linalg.lstsq(rows / scale, target, rcond=1e-12)[0] / scale
    return (F @ move).reshape(seen.e.shape)
