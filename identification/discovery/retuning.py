"""Could the base parameters alone explain what is named, were less known of them?

    loss = min_δ C(q̂ + δ | η = 0) - min_δ C(q̂ + δ),      C: the criterion, its priors WIDER

about the final fit, linearised. A log that moves in one way only tells an effect from a wrong base
parameter by what was said to be known of the latter, and a name that rests on that should say so.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import lsq_linear

from identification.discovery.result import Retuned
from identification.effects.effect import Candidate
from identification.kalman.problem import linearise_criterion
from identification.kalman.refit import Refit

WIDER = 3.0  # times what was known of the base parameters


def retuned(fit: Refit, base: Sequence[str], candidate: Candidate) -> tuple[float, Retuned]:
    """What a model loses with an effect when its base parameters may make up for it.

    Args:
        fit: with the effect.
        base: names of the base parameters.
        candidate: the effect.

    Returns:
        The loss, of twice the log likelihood, and how far the base parameters would have to go;
        its confidence is left at zero. A limit has no size that could go to zero: its loss is
        infinite.
    """
    space, q = fit.point.space, fit.point.q
    names = np.array(space.names)
    own, mine = np.isin(names, base), np.isin(names, candidate.free)
    if not mine.any():
        return np.inf, Retuned(base[0], 0.0, 0.0)
    prior = np.where(own, fit.prior / WIDER, fit.prior)
    problem = linearise_criterion(fit.point, fit.level, fit.mean, prior)
    lower, upper = space.lower - q, space.upper - q
    _, with_it = _least(problem.rows, problem.target, lower, upper)
    rest = ~mine  # sizes are linear coordinates, zero in the nominal model
    target = problem.target + problem.rows[:, mine] @ q[mine]
    move, without = _least(problem.rows[:, rest], target, lower[rest], upper[rest])
    away = np.where(own[rest], (q[rest] + move - fit.mean[rest]) * fit.prior[rest], 0.0)
    far = int(np.abs(away).argmax())
    return max(0.0, without - with_it), Retuned(str(names[rest][far]), float(away[far]), 0.0)


def _least(
    rows: np.ndarray, target: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, float]:
    """The move within bounds that leaves the least of a target, and its square."""
    scale = np.linalg.norm(rows, axis=0) + 1e-300
    Q, R = np.linalg.qr(rows / scale)
    bounds = (lower * scale - 1e-12, upper * scale + 1e-12)
    move = lsq_linear(R, Q.T @ target, bounds).x / scale
    return move, float(np.sum((target - rows @ move) ** 2))
