"""The loss of a fit where something else stands in an effect's place, to first order.

    loss = min_δ,c C(q̂ + δ, c | η = 0) - min_δ C(q̂ + δ)        another effect, of sizes c
    loss = min_δ C'(q̂ + δ | η = 0) - min_δ C'(q̂ + δ)           other values of the nominal model

C is the criterion about the fit, linearised, η the sizes of the effect, and C' the criterion with
wider priors. A log that shows one kind of motion only may tell an effect from a wrong parameter by
nothing but the prior of that parameter, and a name that rests on a prior says so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear

from identification.discovery.effect_results import Retuned
from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.problem import linearise_criterion
from identification.kalman.refit import Refit
from identification.runtime.pool import one_blas_thread

# Factor by which the prior std of the nominal model's parameters are larger where these may explain
# what an effect does.
PRIOR_WIDENING = 3.0


@dataclass(frozen=True)
class Replacement:
    """Something else in the place of an effect."""

    loss: float  # of twice the log likelihood; below zero where it explains more
    share: float  # gain of the effect as a share of its gain
    size: np.ndarray  # its most likely sizes, shape (m,)


def replace_effect(
    fit: Refit, candidate: Candidate, S: np.ndarray, level: NoiseLevel
) -> Replacement:
    """Replace an effect of a fit by something of which the sensitivities are known.

    Args:
        fit: the fit with the effect.
        candidate: the effect.
        S: sensitivities of the outputs to what replaces it, shape (N, ny, m).
        level: the noise.

    Returns:
        An infinite loss for an effect whose size is not estimated (a limit): it cannot be taken out
        by setting the size to zero.
    """
    point, names = fit.point, np.array(fit.point.space.names)
    mine = np.isin(names, candidate.free)
    m = S.shape[2]
    if not mine.any():
        return Replacement(np.inf, np.inf, np.zeros(m))
    with one_blas_thread():
        problem = linearise_criterion(point, level, fit.priors)
        W = problem.filter(S).reshape(point.e.size, m) / level.sigma
    added = np.vstack([W, np.zeros((len(names), m))])
    others = problem.rows[:, ~np.isin(names, candidate.estimated)]
    target = problem.target + problem.rows[:, mine] @ point.q[mine]
    neither = _least(others, target)[0]
    other, move = _least(np.hstack([others, added]), target)
    law = _least(problem.rows, problem.target)[0]
    return Replacement(other - law, (neither - law) / max(neither - other, 1e-300), move[-m:])


def _least(rows: np.ndarray, target: np.ndarray) -> tuple[float, np.ndarray]:
    """Returns the minimum of ‖target - rows move‖², and the move."""
    scale = np.linalg.norm(rows, axis=0) + 1e-300
    move = np.linalg.lstsq(rows / scale, target, rcond=1e-12)[0] / scale
    return float(np.sum((target - rows @ move) ** 2)), move


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
