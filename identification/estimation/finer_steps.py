"""The effect of the steps of the simulation on an estimate of a free run.

    δ = (SᵀS + P)⁻¹ Sᵀ C(ŷ_Δ - ŷ_Δ/4)

It is the step of Gauss and Newton with which an estimate under the step Δ answers when the model is
simulated with a quarter of it. The std of an estimate knows the noise, and nothing of this. Where
dry friction turns within a step, an integrator of any order errs by about Δ, and so does the
estimate. S are the whitened slopes, P the priors, C whitens.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.estimation import Estimate
from identification.model.finer import finer


def step_shift(
    estimate: Estimate, predicted: np.ndarray, S: np.ndarray, prior: np.ndarray,
    whiten: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:  # fmt: skip
    """Returns by how much each value would move with a quarter of the model's step, shape (p,).

    NaN where the plant's step cannot be changed, where it cannot be simulated with a finer one, and
    of a value that a bound holds.

    Args:
        estimate: where a search ended.
        predicted: ŷ there, shape (n, ny), in the outputs' units.
        S: whitened slopes there, shape (n ny, p).
        prior: 1/std of each prior on the diagonal, shape (p, p).
        whiten: C, of columns (n, ny, m) to (n ny, m).
    """
    predictor, q = estimate.predictor, estimate.q
    plant = finer(predictor.plant)
    unknown = np.full(len(q), np.nan)
    if plant is None or estimate.status == "stopped":
        return unknown
    values = estimate.space.decode(q)
    try:
        finely = replace(predictor, plant=plant).predict(values)[0]
    except (DivergenceError, InputError):
        return unknown
    free = ~estimate.space.on_bound(q)
    S, prior = S[:, free], prior[:, free]
    g = S.T @ whiten((predicted - finely)[:, :, None])[:, 0]
    A = S.T @ S + prior.T @ prior
    out = unknown
    out[free] = np.linalg.pinv(A, rcond=1e-14, hermitian=True) @ g
    return out * estimate.space.slope(q)
