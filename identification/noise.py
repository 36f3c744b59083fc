"""The noise of a measurement, seen in the measurement alone.

A smooth signal vanishes in differences of high order; white noise of std σ grows to
σ √C(2n, n) in differences of order n (von Neumann 1941, for n = 1). The median of their sizes
forgets the few samples after a jump of the input, where the signal is not smooth.
"""

from __future__ import annotations

from math import comb

import numpy as np

ORDER = 4
_MEDIAN = 0.6744897501960817  # of |N(0, 1)|


def noise_floor(y: np.ndarray, order: int = ORDER) -> np.ndarray:
    """Std of the white noise on each channel, shape (n, ny) -> (ny,), in the unit of `y`.

    An upper bound where the signal itself is rough at the sampling rate; encoder steps count as
    noise of Δ/√12 as long as the signal crosses some of them.
    """
    rough = np.diff(y, n=min(order, len(y) - 1), axis=0)
    scale = _MEDIAN * np.sqrt(comb(2 * order, order))
    return np.median(np.abs(rough), axis=0) / scale


def whitener_of(residual: np.ndarray) -> np.ndarray:
    """Rows C with Cᵀ C = Λ⁻¹, Λ the covariance of a residual (n, ny), shape (ny, ny)."""
    covariance = residual.T @ residual / len(residual)
    level = np.trace(covariance) / len(covariance)
    floor = 1e-10 * level + np.finfo(float).tiny  # a channel without error must not weigh all
    return np.linalg.inv(np.linalg.cholesky(covariance + floor * np.eye(len(covariance))))
