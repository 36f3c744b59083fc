"""How far unlogged errors of the inputs move a prediction: a free run, or windows of it.

cov(r) = G K Gᵀ            free run from a known start; K: covariance of the errors, G: response
r = (I - X X⁺) G w         a window from its own best start; X: response to that start
"""

from __future__ import annotations

import numpy as np

from identification.kalman.noise_model import Whitener


def propagate_input_error(A: np.ndarray, C: np.ndarray, ratio: float, nu: int) -> np.ndarray:
    """Variance over σ² that input errors cause in a free run, mean over the outputs, shape (N,).

    Args:
        A: transitions of the state of plant and input error, shape (N-1, nz, nz).
        C: outputs from that state, shape (ny, nz).
        ratio: std of an input error over that of the sensors.
        nu: number of inputs.
    """
    if not A.size:
        return np.zeros(0)
    P = np.zeros(A.shape[1:])
    P[-nu:, -nu:] = ratio**2 * np.eye(nu)
    out = [0.0]
    for step in A:
        a = step[-1, -1]
        P = step @ P @ step.T
        P[-nu:, -nu:] += (1 - a**2) * ratio**2 * np.eye(nu)
        out.append(float(np.einsum("ij,jk,ik->", C, P, C)) / len(C))
    return np.array(out)


def propagate_over_windows(
    filter_: Whitener, ratio: float, nu: int, starts: np.ndarray, length: int
) -> np.ndarray:
    """The same over windows that begin in their best state, mean over each window, shape (W,).

    Args:
        filter_: has the transitions of the state of plant and input error.
        ratio: std of an input error over that of the sensors.
        nu: number of inputs.
        starts: first sample of each window, shape (W,).
        length: of a window, in samples.
    """
    if not filter_.A.size:
        return np.zeros(0)
    return np.array([_window(filter_.A[k : k + length - 1], filter_.C, ratio, nu) for k in starts])


def _window(A: np.ndarray, C: np.ndarray, ratio: float, nu: int) -> float:
    nz = A.shape[1]
    nx = nz - nu
    Z = np.zeros((nz, nx + nu * (len(A) + 1)))  # columns: the first state, then the errors
    Z[:nx, :nx], Z[nx:, nx:nz] = np.eye(nx), ratio * np.eye(nu)
    out = [C @ Z]
    for k, step in enumerate(A, start=1):
        Z = step @ Z
        at = nx + nu * k
        Z[nx:, at : at + nu] += np.sqrt(1 - step[-1, -1] ** 2) * ratio * np.eye(nu)
        out.append(C @ Z)
    Y = np.concatenate(out)
    X, G = Y[:, :nx], Y[:, nx:]
    remaining = G - X @ np.linalg.lstsq(X, G, rcond=None)[0]
    return float(np.sum(remaining**2)) / len(Y)
