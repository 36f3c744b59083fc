"""The classic Runge-Kutta method of order 4 with a fixed step, compiled."""

from __future__ import annotations

import numpy as np

from inca_mj.reference.compiled import compiled
from inca_mj.reference.equations import derivative


@compiled
def rk4(x: np.ndarray, i: np.ndarray, q: np.ndarray, h: float, steps: int) -> np.ndarray:
    """Returns the state after `steps` steps of length h under constant currents.

    Args:
        x: state, shape (36,).
        i: currents, shape (8,) [A].
        q: packed numbers, from `pack`.
        h: step [s].
        steps: number of steps.
    """
    for _ in range(steps):
        k1 = derivative(x, i, q)
        k2 = derivative(x + h / 2 * k1, i, q)
        k3 = derivative(x + h / 2 * k2, i, q)
        k4 = derivative(x + h * k3, i, q)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return x
