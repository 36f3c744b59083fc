"""Tests of innovations: are they white, and do all channels have the same variance?

    Σ_i Q_i ~ χ²_{m ny}                  see `identification.estimation.whiteness`
    g = max_f I(f)/Σ_f I(f),  P(g > x) ≈ M (1 - x)^{M-1}                         (Fisher 1929)

I(f) is the periodogram of one channel at M frequencies. The noise model takes a missing effect that
no candidate explains for an error of the inputs. The part of it that is not random (a line of the
spectrum, correlation between samples, one output with a larger variance) remains in the innovations
and is found here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.chances import chi2_above
from identification.estimation.whiteness import whiteness
from identification.kalman.options import KalmanOptions


@dataclass(frozen=True, kw_only=True)
class InnovationTests:
    """Tests of innovations.

    Attributes:
        p_correlation: p-value of the test of Ljung and Box over all channels.
        predictable: share of the power that the correlations would predict, less the share that
            chance would predict, 0 to 1.
        p_line: p-value of the strongest spectral line of all channels.
        channel: index of the output on which that line has the most power.
        frequency: of that line [Hz].
        p_louder: p-value of the test that all channels have the same variance.
        loudest: index of the output with the largest variance.
    """

    p_correlation: float
    predictable: float
    p_line: float
    channel: int
    frequency: float
    p_louder: float
    loudest: int

    def is_correlated(self, options: KalmanOptions) -> bool:
        """Returns whether samples are correlated beyond chance, and by enough to matter."""
        return (
            self.p_correlation < options.structure_level
            and self.predictable > options.min_structure_share
        )


def innovation_tests(E: np.ndarray, sampling_time: float) -> InnovationTests:
    """Test innovations.

    Args:
        E: innovations, shape (N, ny), of any scale that is common to all channels.
        sampling_time: [s].
    """
    n, ny = E.shape
    white = whiteness(E)
    E = E - E.mean(axis=0)
    power = np.mean(E**2, axis=0)
    I = np.abs(np.fft.rfft(E, axis=0)[1 : (n + 1) // 2]) ** 2
    share = I / I.sum(axis=0)
    M = len(I)
    at, sharp = np.unravel_index(int(share.argmax()), share.shape)
    line = ny * M * (1 - share[at, sharp]) ** (M - 1)
    channel = int(I[at].argmax())  # the line has the most power on the output that it comes from
    ratio = power / power.mean()
    louder = float(n / 2 * np.sum((ratio - 1) ** 2))
    return InnovationTests(
        p_correlation=white.p_value,
        predictable=white.predictable,
        p_line=float(min(1.0, line)),
        channel=channel,
        frequency=float((at + 1) / (n * sampling_time)),
        p_louder=float(chi2_above(louder, ny - 1)) if ny > 1 else 1.0,
        loudest=int(ratio.argmax()),
    )
