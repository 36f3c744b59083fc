"""What is left when the noise model has had its share: are the innovations white and even?

    Σ_i Q_i ~ χ²_{m ny}                  see `identification.estimation.whiteness`
    g = max_f I(f)/Σ_f I(f),  P(g > x) ≈ M (1 - x)^{M-1}                         (Fisher 1929)

A missing effect that no candidate explains looks to the noise model like input noise; what is not
random in it (a line of the spectrum, a rhythm of the input, one drive louder than the rest) stays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from identification.estimation.whiteness import whiteness

SURE = 1e-4  # chance at which structure in innovations is believed
MATTERS = 0.03  # share of a mean square below which what explains it is no missing effect


@dataclass(frozen=True, kw_only=True)
class InnovationTests:
    """Tests of innovations.

    Attributes:
        p_correlation: of the test of Ljung and Box over all channels.
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


def innovation_tests(E: np.ndarray, sampling_time: float) -> InnovationTests:
    """Tests of innovations in units of their own std, shape (N, ny)."""
    n, ny = E.shape
    white = whiteness(E)
    E = E - E.mean(axis=0)
    power = np.mean(E**2, axis=0)
    I = np.abs(np.fft.rfft(E, axis=0)[1 : (n + 1) // 2]) ** 2
    share = I / I.sum(axis=0)
    M = len(I)
    at, sharp = np.unravel_index(int(share.argmax()), share.shape)
    line = ny * M * (1 - share[at, sharp]) ** (M - 1)
    ratio = power / power.mean()
    louder = float(n / 2 * np.sum((ratio - 1) ** 2))
    return InnovationTests(
        p_correlation=white.p_value,
        predictable=white.predictable,
        p_line=float(min(1.0, line)),
        channel=int(I[at].argmax()),  # it is the loudest where it comes from
        frequency=float((at + 1) / (n * sampling_time)),
        p_louder=float(chi2.sf(louder, ny - 1)) if ny > 1 else 1.0,
        loudest=int(ratio.argmax()),
    )
