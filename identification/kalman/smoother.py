"""The most likely errors of the inputs, given a whole log: the fixed-interval smoother.

    ẑ_{k|N} = ẑ_{k|k} + G_k (ẑ_{k+1|N} - ẑ_{k+1|k}),    G_k = P_{k|k} A_kᵀ P_{k+1|k}⁻¹

z = (x, w) is the state of `noise_model`: that of the plant and the error of the inputs (Rauch, Tung
and Striebel 1965).
"""

from __future__ import annotations

import numpy as np

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, augment


def smooth(
    plant: LinearPlant, noise: Noise, e: np.ndarray, sampling_time: float
) -> tuple[np.ndarray, np.ndarray]:
    """The most likely errors of the inputs, and their part of the residual.

    Args:
        plant: the linearised plant.
        noise: ρ and τ.
        e: residual, shape (N, ny).
        sampling_time: [s].

    Returns:
        w, shape (N, nu), in the inputs' unit, and its part of the residual, shape (N, ny).
    """
    n, nu = len(e), plant.B.shape[2]
    if noise.ratio == 0:
        return np.zeros((n, nu)), np.zeros_like(e)
    A, C, P, share = augment(plant, noise, sampling_time)
    first, z = P, np.zeros(len(P))
    seen, later = [], []  # (z, P) given the samples up to k, and given those up to k - 1
    for k in range(n):
        later.append((z, P))
        PC = P @ C.T
        K = np.linalg.solve(C @ PC + np.eye(len(C)), PC.T).T
        z, P = z + K @ (e[k] - C @ z), P - K @ PC.T
        seen.append((z, P))
        if k + 1 < n:
            z, P = A[k] @ z, A[k] @ P @ A[k].T + share[k] * first
            P = (P + P.T) / 2
    out = np.empty((n, len(z)))
    out[-1] = seen[-1][0]
    for k in range(n - 2, -1, -1):
        (z, P), (ahead, spread) = seen[k], later[k + 1]
        gain = P @ A[k].T @ np.linalg.pinv(spread, rcond=1e-12, hermitian=True)
        out[k] = z + gain @ (out[k + 1] - ahead)
    return out[:, -nu:], out @ C.T
