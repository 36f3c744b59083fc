"""The criterion at the end of a search, as a number that compares searches of one log.

    trace    V(q) = Σ ρ(r²),                r: all of C W ε and (q - q̄)/s
    det      V(q) = n log det Λ + Σ ((q - q̄)/s)²,    Λ: covariance of W ε

C weighs each output by the noise of its unit, W by relative noise, q̄ ± s is what was known before.
W is that of the measured outputs, because a model that predicts too much may not lower its own
weights, and q̄ is one for all searches.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from identification.estimation.estimation import Estimate
from identification.logs.noise import relative_weight, whitener_of

LOSSES: Mapping[str, Callable[[np.ndarray], np.ndarray]] = {  # ρ of scipy's `least_squares`
    "linear": lambda z: z,
    "soft_l1": lambda z: 2 * (np.sqrt(1 + z) - 1),
    "huber": lambda z: np.where(z <= 1, z, 2 * np.sqrt(z) - 1),
    "cauchy": np.log1p,
    "arctan": np.arctan,
}


def cost(found: Estimate, error: np.ndarray, known: np.ndarray) -> float:
    """Returns V at the end of a search.

    Args:
        found: where it ended.
        error: ε = y - ŷ there, shape (n, ny).
        known: q̄, what was known of each parameter before, shape (p,).
    """
    options, log = found.options, found.predictor.log
    weighed = relative_weight(log.outputs, options.relative_noise) * error
    prior = (found.q - known) * found.priors.weight
    if options.criterion == "det":
        _, size = np.linalg.slogdet(whitener_of(weighed))  # log det Λ = -2 log det C
        return float(-2 * len(error) * size + prior @ prior)
    r = np.concatenate([(weighed @ found.whitener.T).ravel(), prior])
    return float(np.sum(LOSSES[options.loss](r**2)))
