"""What is left when the noise model has had its share: are the innovations white?

    Q = N (N+2) Σ_l r_l²/(N-l)  over L lags and n_y channels  ~  χ²_{L n_y}      (Ljung, Box 1978)
    g = max_f I(f)/Σ_f I(f),  P(g > x) ≈ M (1 - x)^{M-1}                         (Fisher 1929)

A missing effect that no candidate explains looks to the noise model like input noise; what is not
random in it (a line of the spectrum, a rhythm of the input, one drive louder than the rest) stays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

LAGS = 20
SURE = 1e-4  # chance at which structure in innovations is believed
MATTERS = 0.03  # share of a mean square below which what explains it is no missing effect


@dataclass(frozen=True)
class Whiteness:
    """Tests of innovations.

    Attributes:
        p_correlation: of the portmanteau test over all channels.
        predictable: share of the power that the correlations would predict, beyond chance's.
        p_line: of the strongest line over all channels.
        channel: index of the output on which that line is the loudest.
        frequency: of that line [Hz].
        p_louder: that the channels have one variance.
        loudest: index of the output with the largest variance.
    """

    p_correlation: float
    predictable: float
    p_line: float
    channel: int
    frequency: float
    p_louder: float
    loudest: int

    @property
    def correlated(self) -> bool:
        """Whether samples are correlated beyond chance, and by enough to matter."""
        return self.p_correlation < SURE and self.predictable > MATTERS


def whiteness(E: np.ndarray, sampling_time: float) -> Whiteness:
    """Tests of innovations in units of their own std, shape (N, ny)."""
    n, ny = E.shape
    E = E - E.mean(axis=0)
    power = np.mean(E**2, axis=0)
    r = np.array([np.mean(E[lag:] * E[:-lag], axis=0) / power for lag in range(1, LAGS + 1)])
    excess = max(0.0, float(np.sum(r**2) / ny - LAGS / n))
    lags = np.arange(1, LAGS + 1)[:, None]
    Q = float(n * (n + 2) * np.sum(r**2 / (n - lags)))
    I = np.abs(np.fft.rfft(E, axis=0)[1 : (n + 1) // 2]) ** 2
    share = I / I.sum(axis=0)
    M = len(I)
    at, sharp = np.unravel_index(int(share.argmax()), share.shape)
    line = ny * M * (1 - share[at, sharp]) ** (M - 1)
    channel = int(I[at].argmax())  # it is the loudest where it comes from
    ratio = power / power.mean()
    louder = float(n / 2 * np.sum((ratio - 1) ** 2))
    return Whiteness(
        float(chi2.sf(Q, LAGS * ny)),
        excess / (1 + excess),  # a² of a first-order process with the coefficient a
        float(min(1.0, line)),
        channel,
        float((at + 1) / (n * sampling_time)),
        float(chi2.sf(louder, ny - 1)) if ny > 1 else 1.0,
        int(ratio.argmax()),
    )
