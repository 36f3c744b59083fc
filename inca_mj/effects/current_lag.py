"""Lag of the current loop: the motor's current follows the log's as a first-order filter.

    τ i̇ = u - i,  i(0) = p u(0): none before the first sample (p = 0, as of a delay), or it flowed

u is constant over a step, so mean and moment of i over it (see `impulse`) are exact for every
τ >= 0: with c = i(t) - u, s = τ/h, k = e^(-1/s),

    i(t + h) = u + c k,    m = u + c s (1 - k),    D = c s (s - (s + 1) k - ½ (1 - k))
"""

import numpy as np

from identification.effects.effect import BEFORE, Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.impulse import stepwise
from inca_mj.effects.places import DRIVES_EACH


def inputs(currents: np.ndarray, step: float, p: np.ndarray) -> np.ndarray:
    """Lagged current of every step [A], shape (steps, 8)."""
    from scipy.signal import lfilter  # slow to import

    out = currents.copy()
    for k, tau in enumerate(p[0]):
        if tau > 0:
            u, keep = currents[:, k], np.exp(-step / tau)
            i, _ = lfilter([0.0, 1 - keep], [1.0, -keep], u, zi=[p[1][k] * u[0]])
            c, s = i - u, tau / step
            moment = c * s * (s - (s + 1) * keep - (1 - keep) / 2)
            out[:, k] = stepwise(u + c * s * (1 - keep), moment)
    return out


CURRENT_LAG = DriveEffect(
    Effect(
        "current_lag",
        "first-order lag τ of the current loop",
        (Size("tau", "s", 0.01, 5e-4, sign=1, about="time constant"),),
        (BEFORE,),
        places=DRIVES_EACH,
        phrase="motor: current lags",
        reference="Krishnan 2010",
        probes=(1.0, 20**0.5, 20.0),  # to the largest: the outputs follow it only nearly
    ),
    inputs=inputs,
)
