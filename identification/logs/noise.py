"""The noise of a measurement, estimated from the measurement alone.

In differences of high order a smooth signal vanishes, while white noise of std σ has the std σ
√C(2n, n) in differences of order n (von Neumann 1941, for n = 1). The largest three tenths of the
differences are left out, and the std of the others is scaled up as for a Gaussian. So the few
samples after a jump of the input, where the signal is not smooth, do not count.
"""

from __future__ import annotations

from math import comb
from statistics import NormalDist

import numpy as np

ORDER = 8
KEPT = 0.7  # share of the differences that is used
SCATTER = 12.0  # n var(σ̂²)/σ⁴ of `noise_floor` on n samples of white noise, by simulation


def noise_floor(y: np.ndarray, order: int = ORDER) -> np.ndarray:
    """Returns the std of the white noise on each channel of a measurement.

    This is an upper bound where the signal itself is rough at the sampling rate. Encoder steps Δ
    count as noise of Δ/√12 as long as the signal crosses some of them.

    Args:
        y: measured outputs, shape (n, ny), each in a unit of its own.
        order: n of the differences.

    Returns:
        Shape (ny,), in the units of `y`.
    """
    rough = np.sort(np.diff(y, n=min(order, len(y) - 1), axis=0) ** 2, axis=0)
    kept = rough[: max(1, round(KEPT * len(rough)))].mean(axis=0)
    gauss = NormalDist()  # scipy.stats takes a second to import
    z = gauss.inv_cdf((1 + KEPT) / 2)
    share = 1 - 2 * z * gauss.pdf(z) / KEPT  # variance of a Gaussian cut at ±z
    return np.sqrt(kept / share / comb(2 * order, order))


def encoder_step(x: np.ndarray) -> float:
    """Returns the smallest difference of two successive samples that is not zero; 0 without one."""
    steps = np.abs(np.diff(x))
    return float(steps[steps > 0].min()) if steps.any() else 0.0


def whitener_of(residual: np.ndarray) -> np.ndarray:
    """Returns C with Cᵀ C = Λ⁻¹, Λ the covariance of a residual (n, ny); shape (ny, ny)."""
    covariance = residual.T @ residual / len(residual)
    variance = np.diag(covariance)
    # A channel without error must not get all the weight, and units must not change the weights.
    size = np.sqrt(np.maximum(variance, 1e-16 * variance.max() + np.finfo(float).tiny))
    correlation = covariance / np.outer(size, size) + 1e-10 * np.eye(len(size))
    return np.linalg.inv(np.linalg.cholesky(correlation)) / size


def relative_weight(y: np.ndarray, relative: float) -> np.ndarray:
    """Returns weights of residuals with noise of the std `relative` |y|, (n, ny); ones for 0.

    They are scaled so that a sample as large as the signal's rms has the weight 1. A sample near
    zero has almost no such noise; it gets the weight of a sample of 1 % of the rms.
    """
    if relative == 0:
        return np.ones_like(y)
    size = np.sqrt(np.mean(y**2, axis=0))
    return size / np.hypot(y, 0.01 * size)
