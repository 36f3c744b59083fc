"""Tests of residuals and innovations: is anything of the model left in them?

    r_k = Σ_t x_t x_{t-k} / Σ_t x_t²                of each channel, its mean taken off
    Q = N (N+2) Σ_{k≤m} r_k²/(N-k)  ~  χ²_m         whiteness of one channel   (Ljung and Box 1978)
    Σ_i Q_i  ~  χ²_{m ny}                           of all ny channels
    Σ_k r_k² = a²/(1 - a²)                          of a first-order process x_t = a x_{t-1} + ν_t
    √N r_ue(k)/√P ~ N(0, 1),  P = Σ_j r_e(j) r_u(j)     independence         (Ljung 1999, 16.6)
    g = max_f I(f)/Σ_f I(f),  P(g > x) ≈ M (1 - x)^{M-1}   a line of M of the spectrum (Fisher 1929)

A residual may well depend on its own past (coloured noise) while the model is right; one that
depends on the input shows a wrong model. Innovations are white where the model is right. The noise
model takes a missing effect that no candidate explains for an error of the inputs. The part of it
that is not random (a line of the spectrum, correlation between samples) remains in the innovations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.chances import chi2_above, normal_above, normal_level

LAGS = 25  # as MATLAB's resid


@dataclass(frozen=True)
class ResidualTests:
    """p-values per output; a small one contradicts the hypothesis."""

    white: np.ndarray  # that the residual is white, shape (ny,), without unit
    # that it does not depend on any past input, corrected for the number of inputs and lags, shape
    # (ny,), without unit
    independent: np.ndarray


def residual_tests(residual: np.ndarray, inputs: np.ndarray) -> ResidualTests:
    """Test a residual against its own past and against the inputs.

    Args:
        residual: y - ŷ, shape (n, ny), each column in a unit of its own.
        inputs: of the same samples, shape (n, nu), each column in a unit of its own.
    """
    white = whiteness(residual).p_values
    return ResidualTests(white, _independence(residual, inputs))


@dataclass(frozen=True, kw_only=True)
class InnovationTests:
    """Tests of innovations."""

    p_correlation: float  # p-value of the test of Ljung and Box over all channels
    # share of the power that the correlations would predict, less the share that chance would
    # predict, 0 to 1
    predictable: float
    p_line: float  # p-value of the strongest spectral line of all channels
    channel: int  # index of the output on which that line has the most power
    frequency: float  # of that line [Hz]

    def is_correlated(self, level: float, least_share: float) -> bool:
        """Returns whether samples are correlated beyond chance, and by enough to matter."""
        return self.p_correlation < level and self.predictable > least_share


def innovation_tests(E: np.ndarray, sampling_time: float) -> InnovationTests:
    """Test innovations.

    Args:
        E: innovations, shape (N, ny), of any scale that is common to all channels.
        sampling_time: [s].
    """
    n, ny = E.shape
    white = whiteness(E)
    E = E - E.mean(axis=0)
    I = np.abs(np.fft.rfft(E, axis=0)[1 : (n + 1) // 2]) ** 2
    share = I / I.sum(axis=0)
    M = len(I)
    at, sharp = np.unravel_index(int(share.argmax()), share.shape)
    line = ny * M * (1 - share[at, sharp]) ** (M - 1)
    channel = int(I[at].argmax())  # the line has the most power on the output that it comes from
    return InnovationTests(
        p_correlation=white.p_value,
        predictable=white.predictable,
        p_line=float(min(1.0, line)),
        channel=channel,
        frequency=float((at + 1) / (n * sampling_time)),
    )


@dataclass(frozen=True)
class Whiteness:
    """The test of Ljung and Box."""

    r: np.ndarray  # autocorrelation at the lags 1..m, shape (m, ny)
    samples: int  # N

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


def whiteness(x: np.ndarray) -> Whiteness:
    """Test a signal (N, ny) at up to `LAGS` lags, no more than a quarter of its samples."""
    return Whiteness(autocorrelation(x, min(LAGS, len(x) // 4))[1:], len(x))


def autocorrelation(x: np.ndarray, lags: int) -> np.ndarray:
    """Returns each column's normalised autocorrelation at lags 0..lags, (n, m) -> (lags + 1, m)."""
    x = x - x.mean(axis=0)
    power = (x * x).sum(axis=0)
    power = np.where(power > 0, power, 1.0)
    return np.stack([(x[k:] * x[: len(x) - k]).sum(axis=0) / power for k in range(lags + 1)])


def correlation_time(residual: np.ndarray) -> float:
    """Returns the integrated autocorrelation time of the most persistent column [samples].

    Summed up to the first lag that is not significantly positive (Geyer's initial sequence).
    """
    r = autocorrelation(residual, min(LAGS, len(residual) - 1))[1:]
    significant = np.cumprod(r > normal_level(0.01) / np.sqrt(len(residual)), axis=0)
    return float(1 + 2 * (r * significant).sum(axis=0).max())


def _independence(residual: np.ndarray, inputs: np.ndarray) -> np.ndarray:
    n = len(residual)
    lags = min(LAGS, n // 4)
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
