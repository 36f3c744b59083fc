"""Sensitivities under a noise, with the filter that whitened them: computed once, and kept a while.

    F = W Φ,    H = FᵀF              W: the whitening filter of the noise

The noise that is found at a point is that of its criterion, of its scores and of the std of its
estimate, and after a short step the columns are those from before it. So the last ones are kept.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, Whitener, build_whitener

KEPT_POINTS = 2  # where a search is, and where it came from

_kept: deque[Whitened] = deque(maxlen=KEPT_POINTS)


@dataclass(frozen=True, eq=False)
class Whitened:
    """Whitened sensitivities.

    Attributes:
        plant: the linearised plant of the filter.
        J: the sensitivities, shape (N, ny, p).
        noise: ρ and τ.
        filter: the whitening filter.
        F: the whitened sensitivities, shape (N ny, p).
    """

    plant: LinearPlant
    J: np.ndarray
    noise: Noise
    filter: Whitener
    F: np.ndarray

    @cached_property
    def H(self) -> np.ndarray:
        """FᵀF, shape (p, p)."""
        return self.F.T @ self.F


def whiten(plant: LinearPlant, J: np.ndarray, noise: Noise, sampling_time: float) -> Whitened:
    """Whiten sensitivities, or take them from those that were kept.

    Args:
        plant: the linearised plant.
        J: sensitivities, shape (N, ny, p).
        noise: ρ and τ.
        sampling_time: [s].
    """
    for known in (*_kept,):
        if known.plant is plant and known.J is J and known.noise == noise:
            return known
    filter_ = build_whitener(plant, noise, sampling_time)
    samples, outputs, p = J.shape
    F = filter_(J).reshape(samples * outputs, p)
    return Whitened(plant, J, noise, filter_, F)


def keep(whitened: Whitened) -> None:
    """Keep whitened sensitivities in place of the oldest ones that are kept."""
    if not any(known is whitened for known in _kept):
        _kept.append(whitened)
