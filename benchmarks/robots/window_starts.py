"""The first state of each window from which a simulator of others explains the window best.

    min_x0 ‖y_w - ŷ_w(x0)‖²             Levenberg and Marquardt, each window with its own damping

So their models are compared with ours on the same windows, and none is blamed for a wrong start.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

STEPS, FEWEST = 30, 5  # linearisations; windows whose damping is too small gain nothing at first
FIRST_DAMPING = 1e-3  # of the squared norms of a window's columns
PROBE = 1e-6  # change of a state, in units of its scale

Simulate = Callable[[np.ndarray], np.ndarray]  # first states (W, n) -> outputs (W, L, ny)


def best_errors(
    simulate: Simulate, outputs: np.ndarray, first: np.ndarray, scale: np.ndarray
) -> np.ndarray:
    """y - ŷ of each window from its best first state, shape (W, L, ny).

    Args:
        simulate: outputs (W, L, ny) of all windows from their first states (W, n).
        outputs: measured, shape (W, L, ny).
        first: where the search begins, shape (W, n).
        scale: a magnitude that matters of each state, shape (n,).
    """
    x = np.array(first, float)
    W, n = x.shape
    error = (outputs - simulate(x)).reshape(W, -1)
    cost = np.sum(error**2, axis=1)
    damping = np.full(W, FIRST_DAMPING)
    for step in range(STEPS):
        slopes = []
        for j in range(n):
            moved = x.copy()
            moved[:, j] += PROBE * scale[j]
            slopes.append((outputs - simulate(moved)).reshape(W, -1) - error)
        S = np.stack(slopes, axis=-1) / PROBE  # (W, L ny, n), in units of the scale
        H = np.einsum("wki,wkj->wij", S, S)
        g = np.einsum("wki,wk->wi", S, error)
        D = np.einsum("wii->wi", H)
        H = (
            H
            + np.eye(n)
            * (damping[:, None] * D + 1e-12 * D.max(1, keepdims=True) + 1e-300)[:, :, None]
        )
        tried = x - scale * np.linalg.solve(H, g[:, :, None])[:, :, 0]
        found = (outputs - simulate(tried)).reshape(W, -1)
        new = np.sum(found**2, axis=1)
        better = new < cost
        x[better], error[better] = tried[better], found[better]
        gained = np.where(better, cost - new, 0.0)
        cost = np.where(better, new, cost)
        damping = np.where(better, damping / 10, damping * 10)
        if step > FEWEST and np.all(gained <= 1e-9 * cost):
            break
    return error.reshape(outputs.shape)
