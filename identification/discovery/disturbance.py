"""The effect of unlogged errors of the inputs on a prediction: a free run, or windows of it.

cov(r) = G K Gᵀ            free run from a known start; K: covariance of the errors, G: response
r = (I - X X⁺) G w         a window from its own best start; X: response to that start
"""

from __future__ import annotations

import numpy as np

from identification.kalman.recursion import propagate


def propagate_input_error(A: np.ndarray, C: np.ndarray, ratio: float, nu: int) -> np.ndarray:
    """Returns the variance over σ² that input errors cause in a free run, shape (N, ny).

    Args:
        A: transitions of the state of plant and input error, shape (N-1, nz, nz).
        C: outputs from that state, shape (ny, nz).
        ratio: std of an input error over that of the sensors.
        nu: number of inputs.
    """
    if not A.size:
        return np.zeros((0, len(C)))
    P = np.zeros(A.shape[1:])
    P[-nu:, -nu:] = ratio**2 * np.eye(nu)
    moved = propagate(A, C, P, 1 - A[:, -1, -1] ** 2)
    return np.vstack([np.zeros(len(C)), moved])
