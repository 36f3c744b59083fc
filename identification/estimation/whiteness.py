"""Tests of whether a signal is white.

r_k = Σ_t x_t x_{t-k} / Σ_t x_t²                   of each channel, its mean taken off
Q = N (N+2) Σ_{k≤m} r_k²/(N-k)  ~  χ²_m            of one channel       (Ljung and Box 1978)
Σ_i Q_i  ~  χ²_{m ny}                              of all ny channels
Σ_k r_k² = a²/(1 - a²)                             of a first-order process x_t = a x_{t-1} + ν_t
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.chances import chi2_above, normal_level

LAGS = 25  # as MATLAB's resid


@dataclass(frozen=True)
class Whiteness:
    """The test of Ljung and Box.

    Attributes:
        r: autocorrelation at the lags 1..m, shape (m, ny).
        samples: N.
    """

    r: np.ndarray
    samples: int

    @property
    def Q(self) -> np.ndarray:
        """The statistic of each channel, shape (ny,)."""
        n, m = self.samples, len(self.r)
        return n * (n + 2) * (self.r**2 / (n - np.arange(1, m + 1))[:, None]).sum(axis=0)

    @property
    def p_values(self) -> np.ndarray:
        """Chance that each channel, if it is white, looks less white still, shape (ny,)."""
        return chi2_above(self.Q, len(self.r))

    @property
    def p_value(self) -> float:
        """The p-value of all channels together."""
        return float(chi2_above(self.Q.sum(), self.r.size))

    @property
    def predictable(self) -> float:
        """Share of the power that the correlations would predict, beyond chance's.

        It is a² of a first-order process with the coefficient a.
        """
        m, ny = self.r.shape
        excess = max(0.0, float(np.sum(self.r**2) / ny - m / self.samples))
        return excess / (1 + excess)


def whiteness(x: np.ndarray, lags: int = LAGS) -> Whiteness:
    """Test a signal (N, ny) at 1..lags, and no more lags than a quarter of its samples."""
    return Whiteness(autocorrelation(x, min(lags, len(x) // 4))[1:], len(x))


def autocorrelation(x: np.ndarray, lags: int) -> np.ndarray:
    """Returns each column's normalised autocorrelation at lags 0..lags, (n, m) -> (lags + 1, m)."""
    x = x - x.mean(axis=0)
    power = (x * x).sum(axis=0)
    power = np.where(power > 0, power, 1.0)
    return np.stack([(x[k:] * x[: len(x) - k]).sum(axis=0) / power for k in range(lags + 1)])


def correlation_time(residual: np.ndarray, lags: int = LAGS) -> float:
    """Returns the integrated autocorrelation time of the most persistent column [samples].

    Summed up to the first lag that is not significantly positive (Geyer's initial sequence).
    """
    r = autocorrelation(residual, min(lags, len(residual) - 1))[1:]
    significant = np.cumprod(r > normal_level(0.01) / np.sqrt(len(residual)), axis=0)
    return float(1 + 2 * (r * significant).sum(axis=0).max())
