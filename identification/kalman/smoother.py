"""The most likely errors of the inputs, given a whole log: the fixed-interval smoother.

    u = Wᵀ W e,    e - u = C ẑ                          W: the whitening filter
    r_k = (A_k - A_k K_k C)ᵀ r_{k+1} + Cᵀ S_k⁻¹ ε_k
    ŵ_{k+1} = a ŵ_k + q_k r_{k+1},    ŵ_0 = ρ² r_0      of r the part that belongs to w

z = (x, w) is the state of `noise_model`: that of the plant and the error of the inputs (Durbin and
Koopman 2012, section 4.6). Nothing but vectors is propagated: the covariances of the filter and of
the smoother are not needed.
"""

from __future__ import annotations

import numpy as np

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, augment
from identification.kalman.recursion import filter_gains, filter_innovations, transpose_filter


def smooth(
    plant: LinearPlant, noise: Noise, e: np.ndarray, sampling_time: float
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the most likely errors of the inputs, and their part of the residual.

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
    K, L, _ = filter_gains(A, C, P, share)
    E = filter_innovations(A, C, K, L, e[..., None])[..., 0]
    u, r = transpose_filter(A, C, K, L, E)
    fresh = noise.ratio**2 * np.concatenate([[1.0], share])[:, None] * r[:, -nu:]
    w = np.empty((n, nu))
    w[0] = now = fresh[0]
    for k, a in enumerate(A[:, -1, -1]):
        w[k + 1] = now = a * now + fresh[k + 1]
    return w, e - u
