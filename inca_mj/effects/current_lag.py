"""Lag of the current loop: the motor's current follows the log's as a first-order filter.

    τ i̇ = u - i,  i(0) = 0: no current before the first sample, as of a delay

u is constant over a step, so the mean of i over it is exact for every τ >= 0:

    i(t + h) = u + (i(t) - u) e^(-h/τ)        mean = u + (i(t) - u) (τ/h) (1 - e^(-h/τ))
"""

import numpy as np
from scipy.signal import lfilter

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


def inputs(currents: np.ndarray, step: float, p: np.ndarray) -> np.ndarray:
    """Mean lagged current of every step [A], shape (steps, 8)."""
    out = currents.copy()
    for k, tau in enumerate(p[0]):
        if tau > 0:
            u, keep = currents[:, k], np.exp(-step / tau)
            i, _ = lfilter([0.0, 1 - keep], [1.0, -keep], u, zi=[0.0])
            out[:, k] = u + (i - u) * (tau / step) * (1 - keep)
    return out


CURRENT_LAG = DriveEffect(
    Effect(
        "current_lag",
        "first-order lag τ of the current loop",
        (Size("tau", "s", 0.01, 5e-4, sign=1, about="time constant"),),
        places=DRIVES_EACH,
        phrase="motor: current lags",
        reference="Krishnan 2010",
    ),
    inputs=inputs,
)
