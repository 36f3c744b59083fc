"""What may happen to an input on its way to the model, step by step; u is held over a step h.

    delay        u(t - τ)                     mean over each step of the late input
    lag          τ u̇' = u - u'                mean over each step, u'(0) = p u(0)
    saturation   u + c (clip(u, ±u_max) - u)  c = 1 where there is a limit
    gain drift   (1 - α t) u

Before the first sample p u(0) comes: nothing (p = 0), or what had been there. Each function takes
the input of every step, the step [s] and the effect's numbers, sizes first; with sizes of zero it
returns the input as it is. A mean keeps the impulse of a step; its moment is lost, an error of
second order in h.
"""

from __future__ import annotations

import numpy as np


def delayed(u: np.ndarray, step: float, tau: float, before: float = 0.0) -> np.ndarray:
    """The input τ later, shape (steps,)."""
    if tau <= 0:
        return u
    n, f = divmod(tau / step, 1.0)
    return (1 - f) * _late(u, int(n), before) + f * _late(u, int(n) + 1, before)


def lagged(u: np.ndarray, step: float, tau: float, before: float = 0.0) -> np.ndarray:
    """The input through a first-order filter, shape (steps,)."""
    if tau <= 0:
        return u
    from scipy.signal import lfilter  # slow to import

    s, keep = tau / step, np.exp(-step / tau)
    begun, _ = lfilter([0.0, 1 - keep], [1.0, -keep], u, zi=[before * u[0]])
    return u + (begun - u) * s * (1 - keep)


def clipped(u: np.ndarray, step: float, c: float, u_max: float) -> np.ndarray:
    """The input within ±u_max, as far as c says, shape (steps,)."""
    return u if c == 0 else u + c * (np.clip(u, -u_max, u_max) - u)


def drifting(u: np.ndarray, step: float, alpha: float) -> np.ndarray:
    """The input of a drive whose gain falls with time, shape (steps,)."""
    return u if alpha == 0 else (1 - alpha * step * (np.arange(len(u)) + 0.5)) * u


def _late(u: np.ndarray, n: int, before: float) -> np.ndarray:
    return np.concatenate([np.full(min(n, len(u)), before * u[0]), u[: max(0, len(u) - n)]])
