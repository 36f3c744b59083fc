"""Delay of the input: the current arrives late.

    i(t) = u(t - τ),  p u(0) before the first sample has arrived: none (p = 0), or it flowed

u is constant over a step, so mean and moment of i over it (see `impulse`) are exact for every
τ >= 0: with τ = (n + f) h,

    m_k = (1 - f) u_(k-n) + f u_(k-n-1)        D_k = ½ f (1 - f) (u_(k-n) - u_(k-n-1))
"""

import numpy as np

from identification.effects.effect import BEFORE, Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.impulse import stepwise
from inca_mj.effects.places import DRIVES_EACH


def inputs(currents: np.ndarray, step: float, p: np.ndarray) -> np.ndarray:
    """Delayed current of every step [A], shape (steps, 8)."""
    out = currents.copy()
    for k, tau in enumerate(p[0]):
        if tau > 0:
            n, f = divmod(tau / step, 1.0)
            new, old = (_late(currents[:, k], int(n) + more, p[1][k]) for more in (0, 1))
            out[:, k] = stepwise((1 - f) * new + f * old, f * (1 - f) / 2 * (new - old))
    return out


def _late(u: np.ndarray, n: int, before: float) -> np.ndarray:
    return np.concatenate([np.full(min(n, len(u)), before * u[0]), u[: max(0, len(u) - n)]])


DELAY = DriveEffect(
    Effect(
        "delay",
        "pure delay of the input",
        (Size("tau", "s", 0.02, 5e-4, sign=1, about="delay"),),
        (BEFORE,),
        places=DRIVES_EACH,
        phrase="motor: current comes late",
        reference="Åström, Hägglund 2006",
        probes=(1.0, 40**0.5, 40.0),  # to the largest: the outputs follow it only nearly
    ),
    inputs=inputs,
)
