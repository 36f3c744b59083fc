"""The profile of one parameter: the smallest criterion at each of its values.

    V_p(c) = min over the others of V(q | q_j = c),    V = Σ ρ((C W ε)²)
    95 %:  V_p(c) - V_p(q̂_j) < 3.84 s_j²,    s_j² = c cov(q̂)_jj / (A⁻¹)_jj       (Kent 1982)

3.84 is the 95 % point of χ² with one degree of freedom (Venzon and Moolgavkar 1988). cov and c are
those of `identification.estimation.uncertainty`, ρ is the loss of the search, W are the weights of
relative noise, and A = Σ SᵀS: the curvature of V is c A. For white noise and least squares s_j² =
V(q̂)/(n ny - p); for a coloured residual it is larger. Where V is a parabola this is the interval
q̂ ± 1.96 std; where it is not, the profile is right and the std is not. If the profile stays below
the line on one side, or cannot be simulated there, the log does not determine the parameter, and
the interval is open on that side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.chances import chi2_level
from identification.errors import DivergenceError, InputError
from identification.estimation.estimation import Estimate
from identification.estimation.estimation import estimate as search
from identification.estimation.fit import Fit
from identification.estimation.uncertainty import LOSSES, influence
from identification.runtime.progress import stage

PROFILE_LEVEL = chi2_level(0.05, 1)  # 3.84
REACH_STDS = 3.0  # to each side, unless points are given
MAX_REACH = 0.5  # of q to each side where the std is larger or infinite
MAX_EVALUATIONS = 30  # simulations of the outputs for each point


@dataclass(frozen=True, kw_only=True)
class Profile:
    """The smallest cost at given values of one parameter."""

    name: str  # the parameter
    estimate: float  # its estimated value
    values: np.ndarray  # the values at which it was held, ascending, shape (k,), in its unit
    # V_p - V(q̂) in units of s_j², infinite where no simulation was possible, shape (k,)
    rise: np.ndarray
    # the best values of the other parameters there, by name, each of shape (k,) in its unit
    others: dict[str, np.ndarray]
    # 95 % interval of the value; an end that the profile does not reach is infinite
    interval: tuple[float, float]

    @property
    def open(self) -> bool:
        """Tells whether an end of the interval was not found between the given values."""
        return bool(np.isinf(self.interval).any())


def profile(fit: Fit, name: str, points: int | Sequence[float] = 9) -> Profile:
    """Profiles one parameter of a fit: at each of its values the others are fitted again.

    Args:
        fit: an estimate and its uncertainty.
        name: the parameter.
        points: values of it, or how many to spread over ±3 std of its coordinate.

    Raises:
        InputError: the name is not among the estimated ones, or fewer than two values remain.
    """
    estimate = fit.estimate
    names = estimate.space.names
    if name not in names:
        raise InputError(f"{name!r} was not estimated; profile one of {', '.join(names)}")
    j, best = names.index(name), estimate.values
    values = _spread(fit, j, points) if isinstance(points, int) else np.sort(points)
    if len(values) < 2:
        raise InputError(f"a profile of {name} needs two values or more inside its bounds")
    bottom = _cost(estimate, best)
    scale = _scale(fit, j, bottom)
    rise, found = np.full(len(values), np.inf), [best] * len(values)
    middle = int(np.searchsorted(values, best[name]))
    with stage(f"values of {name}", len(values)) as advance:
        for way in (range(middle, len(values)), range(middle - 1, -1, -1)):
            near = best
            for i in way:
                try:
                    near = _refit(estimate, name, float(values[i]), near)
                    found[i], rise[i] = near, (_cost(estimate, near) - bottom) / scale
                except DivergenceError:
                    break
                advance()
    others = {n: np.array([f[n] for f in found]) for n in names if n != name}
    ends = (_crossing(values, rise, best[name], -1), _crossing(values, rise, best[name], 1))
    return Profile(
        name=name, estimate=best[name], values=values, rise=rise, others=others, interval=ends
    )


def _std_q(fit: Fit, j: int) -> float:
    """Returns the std of q_j; infinite where the log does not determine it."""
    return float(fit.std[j] / fit.estimate.space.slope(fit.estimate.q)[j])


def _scale(fit: Fit, j: int, bottom: float) -> float:
    """Returns s_j², or its value for white noise where the log does not determine q_j."""
    known, alone = _std_q(fit, j), float(fit.found.std[j])
    freedom = max(1, fit.residual.size - len(fit.std))
    both = np.isfinite(known) and np.isfinite(alone) and known > 0
    curvature = influence(_weighed(fit.estimate, fit.residual), fit.estimate.options.loss)[1]
    return max(curvature * (known / alone) ** 2 if both else bottom / freedom, np.finfo(float).tiny)


def _spread(fit: Fit, j: int, points: int) -> np.ndarray:
    """Returns values evenly spaced in q_j, inside the bounds."""
    space, q = fit.estimate.space, fit.estimate.q
    reach = min(REACH_STDS * _std_q(fit, j), MAX_REACH)
    moves = np.tile(q, (points, 1))
    moves[:, j] += np.linspace(-reach, reach, points)
    inside = (moves[:, j] > space.lower[j]) & (moves[:, j] < space.upper[j])
    return space.decode(moves[inside])[:, j]


def _refit(estimate: Estimate, name: str, value: float, near: dict[str, float]) -> dict[str, float]:
    """Fits the other parameters again while one is held, from a neighbouring point."""
    predictor, options = estimate.predictor, estimate.options
    held = {**predictor.fixed, **near, name: value}
    free = tuple(n for n in near if n != name)
    if not free:
        return {name: value}
    once = replace(
        options, horizons=(1.0,), criterion="trace", max_evaluations=MAX_EVALUATIONS, priors={}
    )
    found = search(
        predictor.plant, predictor.log, free, held, once, whitener=estimate.whitener
    ).values
    return {n: value if n == name else found[n] for n in near}


def _cost(estimate: Estimate, values: dict[str, float]) -> float:
    """Returns V of the estimate's criterion, with the same covariance, weights and loss."""
    row = np.array([[values[n] for n in estimate.space.names]])
    error = estimate.predictor.log.outputs - estimate.predictor.predict(row)[0]
    loss = LOSSES[estimate.options.loss].value
    return float(np.sum(loss(_weighed(estimate, error) ** 2)))


def _weighed(estimate: Estimate, error: np.ndarray) -> np.ndarray:
    """Returns C W ε, shape (n, ny), of errors ε in the outputs' units."""
    return (estimate.weight * error) @ estimate.whitener.T


def _crossing(values: np.ndarray, rise: np.ndarray, best: float, side: int) -> float:
    """Returns where the profile crosses the level on one side; √rise is nearly a straight line."""
    order = np.argsort(side * values)
    beyond = order[side * values[order] > side * best]
    inner_value, inner = best, 0.0
    for i in beyond:
        root = float(np.sqrt(max(0.0, rise[i])))
        if root > np.sqrt(PROFILE_LEVEL):
            if np.isinf(root):  # there is no simulation here, so the rise is not known
                break
            share = (np.sqrt(PROFILE_LEVEL) - inner) / (root - inner)
            return float(inner_value + share * (values[i] - inner_value))
        inner_value, inner = float(values[i]), root
    return side * np.inf
