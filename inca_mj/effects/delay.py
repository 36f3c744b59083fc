"""Delay of the input: the current arrives late, and is zero before the first sample has arrived.

    i(t) = u(t - τ)

u is constant over a step, so mean and moment of i over it (see `impulse`) are exact for every
τ >= 0: with τ = (n + f) h,

    m_k = (1 - f) u_(k-n) + f u_(k-n-1)        D_k = ½ f (1 - f) (u_(k-n) - u_(k-n-1))
"""

import numpy as np

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.impulse import stepwise
from inca_mj.effects.places import DRIVES_EACH


def inputs(currents: np.ndarray, step: float, p: np.ndarray) -> np.ndarray:
    """Delayed current of every step [A], shape (steps, 8)."""
    out = currents.copy()
    for k, tau in enumerate(p[0]):
        if tau > 0:
            n, f = divmod(tau / step, 1.0)
            new, old = (_late(currents[:, k], int(n) + more) for more in (0, 1))
            out[:, k] = stepwise((1 - f) * new + f * old, f * (1 - f) / 2 * (new - old))
    return out


def _late(u: np.ndarray, n: int) -> np.ndarray:
    return np.concatenate([np.zeros(min(n, len(u))), u[: max(0, len(u) - n)]])


DELAY = DriveEffect(
    Effect(
        "delay",
        "pure delay of the input, zero before the first sample",
        (Size("tau", "s", 0.02, 5e-4, sign=1, about="delay"),),
        places=DRIVES_EACH,
        phrase="motor: current comes late",
        reference="Åström, Hägglund 2006",
        probes=(1.0, 40**0.5, 40.0),  # to the largest: the outputs follow it only nearly
    ),
    inputs=inputs,
)
