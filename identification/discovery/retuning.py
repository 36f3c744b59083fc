"""Could the nominal model's parameters explain what an effect explains, if less were known of them?

    loss = min_δ C(q̂ + δ | η = 0) - min_δ C(q̂ + δ),      C: the criterion with wider priors

about the final fit, linearised. A log that shows one kind of motion only may tell an effect from a
wrong parameter by nothing but the prior of that parameter. A name that rests on a prior says so.

An effect that says "this part deviates from its kind by more than parts do" is a statement about a
prior. The deviations of that kind keep theirs: with wider ones such a part would be ordinary.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import lsq_linear

from identification.discovery.effect_results import Retuned
from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.kalman.problem import linearise_criterion
from identification.kalman.refit import Refit

# Factor by which the prior std of the nominal model's parameters are larger where these may explain
# what an effect does.
PRIOR_WIDENING = 3.0


def retune(fit: Refit, nominal: NominalModel, candidate: Candidate) -> tuple[float, Retuned]:
    """Returns the loss of a fit without an effect when the nominal parameters may replace it.

    Args:
        fit: the fit with the effect.
        nominal: the nominal model, whose parameters may move.
        candidate: the effect.

    Returns:
        The loss, of twice the log likelihood, and how far the parameters would have to move; its
        confidence is zero and is computed later. An effect whose size is not estimated (a limit)
        cannot be taken out by setting the size to zero: its loss is infinite.
    """
    space, q = fit.point.space, fit.point.q
    names = np.array(space.names)
    own, mine = np.isin(names, nominal.names), np.isin(names, candidate.free)
    if not mine.any():
        return np.inf, Retuned(nominal.names[0], 0.0, 0.0)
    kind = [n for n, (effect, _) in nominal.deviants.items() if effect == candidate.effect.name]
    wider = own & ~np.isin(names, kind)
    known = fit.priors
    widened = np.where(wider, known.weight / PRIOR_WIDENING, known.weight)
    problem = linearise_criterion(fit.point, fit.level, replace(known, weight=widened))
    lower, upper = space.lower - q, space.upper - q
    _, with_it = _minimise(problem.rows, problem.target, lower, upper)
    rest = ~mine  # the coordinates of sizes are linear, and zero in the nominal model
    target = problem.target + problem.rows[:, mine] @ q[mine]
    move, without = _minimise(problem.rows[:, rest], target, lower[rest], upper[rest])
    away = np.where(own[rest], (q[rest] + move - known.mean[rest]) * known.weight[rest], 0.0)
    far = int(np.abs(away).argmax())
    return max(0.0, without - with_it), Retuned(str(names[rest][far]), float(away[far]), 0.0)


def _minimise(
    rows: np.ndarray, target: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, float]:
    """Returns the move within bounds that minimises ‖target - rows move‖², and that minimum."""
    scale = np.linalg.norm(rows, axis=0) + 1e-300
    Q, R = np.linalg.qr(rows / scale)
    bounds = (lower * scale - 1e-12, upper * scale + 1e-12)
    move = lsq_linear(R, Q.T @ target, bounds).x / scale
    return move, float(np.sum((target - rows @ move) ** 2))
