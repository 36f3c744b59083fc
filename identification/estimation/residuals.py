"""Tests of a residual: is anything of the model left in it?

    whiteness       see `identification.estimation.whiteness`
    independence    √N r_ue(k)/√P ~ N(0, 1),  P = Σ_j r_e(j) r_u(j)   (Ljung 1999, 16.6)

r are normalised correlations. A residual may well depend on its own past (coloured noise) while
the model is right; one that depends on the input shows a wrong model.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.chances import normal_above
from identification.estimation.whiteness import LAGS, autocorrelation, whiteness


@dataclass(frozen=True)
class ResidualTests:
    """p-values per output; a small one contradicts the hypothesis.

    Attributes:
        white: that the residual is white, shape (ny,), without unit.
        independent: that it does not depend on any past input, corrected for the number of inputs
            and lags, shape (ny,), without unit.
    """

    white: np.ndarray
    independent: np.ndarray


def residual_tests(residual: np.ndarray, inputs: np.ndarray, lags: int = LAGS) -> ResidualTests:
    """Test a residual against its own past and against the inputs.

    Args:
        residual: y - ŷ, shape (n, ny), each column in a unit of its own.
        inputs: of the same samples, shape (n, nu), each column in a unit of its own.
        lags: how many samples back.
    """
    white = whiteness(residual, lags).p_values
    return ResidualTests(white, _independence(residual, inputs, lags))


def _independence(residual: np.ndarray, inputs: np.ndarray, lags: int) -> np.ndarray:
    n = len(residual)
    lags = min(lags, n // 4)
    e, u = residual - residual.mean(axis=0), inputs - inputs.mean(axis=0)
    moving = u.std(axis=0) > 0
    if not moving.any():
        return np.ones(residual.shape[1])
    u = u[:, moving] / u[:, moving].std(axis=0)
    scale = e.std(axis=0)
    e = e / np.where(scale > 0, scale, 1.0)
    r_e, r_u = autocorrelation(e, lags), autocorrelation(u, lags)
    P = 1 + 2 * np.einsum("lj,li->ji", r_e[1:], r_u[1:])  # (ny, nu)
    cross = np.stack([e[k:].T @ u[: n - k] / n for k in range(lags + 1)])  # (lags, ny, nu)
    z = np.abs(cross) * np.sqrt(n) / np.sqrt(np.maximum(P, 1e-3))
    tests = cross.shape[0] * cross.shape[2]
    return np.minimum(1.0, tests * 2 * normal_above(z.max(axis=(0, 2))))
