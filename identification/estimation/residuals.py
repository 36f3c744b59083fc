"""Is anything of the model left in what it could not predict?

    whiteness       Q = N (N+2) Σ_{k≤m} r_k²/(N-k) ~ χ²_m             (Ljung and Box 1978)
    independence    √N r_ue(k)/√P ~ N(0, 1),  P = Σ_j r_e(j) r_u(j)   (Ljung 1999, 16.6)

r are normalised correlations. A residual may well depend on its own past (coloured noise) while
the model is right; one that depends on the input shows a wrong model.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2, norm

LAGS = 25  # as MATLAB's resid


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
    return ResidualTests(_whiteness(residual, lags), _independence(residual, inputs, lags))


def autocorrelation(x: np.ndarray, lags: int) -> np.ndarray:
    """Normalised autocorrelation at lags 0..lags of each column, (n, m) -> (lags + 1, m)."""
    x = x - x.mean(axis=0)
    power = (x * x).sum(axis=0)
    power = np.where(power > 0, power, 1.0)
    return np.stack([(x[k:] * x[: len(x) - k]).sum(axis=0) / power for k in range(lags + 1)])


def correlation_time(residual: np.ndarray, lags: int = LAGS) -> float:
    """Integrated autocorrelation time of the most persistent column [samples], 1 when white.

    Summed up to the first lag that is not significantly positive (Geyer's initial sequence).
    """
    r = autocorrelation(residual, min(lags, len(residual) - 1))[1:]
    significant = np.cumprod(r > norm.ppf(0.99) / np.sqrt(len(residual)), axis=0)
    return float(1 + 2 * (r * significant).sum(axis=0).max())


def _whiteness(residual: np.ndarray, lags: int) -> np.ndarray:
    n = len(residual)
    lags = min(lags, n // 4)
    r = autocorrelation(residual, lags)[1:]
    Q = n * (n + 2) * (r**2 / (n - np.arange(1, lags + 1))[:, None]).sum(axis=0)
    return chi2.sf(Q, lags)


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
    return np.minimum(1.0, tests * 2 * norm.sf(z.max(axis=(0, 2))))
