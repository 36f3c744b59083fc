"""How the errors of windows lie along what is slow, and how many of their readings are independent.

    v_ky = Σ_w (d_kᵀ r⊥_wy)²/Σ_w ‖d_k⊥w‖²       mean square of the errors of output y along d_k
    v_y = max(σ_y², max_k v_ky)
    n_y = max(1, ν_y σ_y²/v_y)                  of ν_y = L - Σ ‖U_y‖² readings of a window

d_k are the slowest cosines over a window, as whatever a missing force makes is slow; r⊥ and d_k⊥:
errors and cosines without what the state of the window makes up for; σ_y²: mean square of the
errors over all readings. Where errors are those of a sensor, no direction has more than another,
and every reading counts. Where a window is wrong as a whole, as by an error of its input, they lie
along few of these directions, and the window is one reading or two.
"""

from __future__ import annotations

import numpy as np

from identification.windows.fit import WindowFit

COSINES = 5  # of them the state makes up for two or so
LEAST_NORM = 1e-3  # share of a cosine: with less left of it, the state makes up for it


def slow_square(fit: WindowFit) -> np.ndarray:
    """Returns v, the mean square along what is slow of each whitened output, shape (ny,).

    Args:
        fit: a model, fitted.
    """
    return _squares(fit)[1]


def independent_readings(fit: WindowFit) -> np.ndarray:
    """Returns the mean number of independent readings of each output in a window, shape (ny,).

    Args:
        fit: a model, fitted.
    """
    usual, slow, readings = _squares(fit)
    share = np.divide(usual, slow, out=np.ones_like(usual), where=slow > 0)
    return np.asarray(np.maximum(1.0, readings * share))


def _squares(fit: WindowFit) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns σ², v and ν of each output, shape (ny,)."""
    L, ny = fit.problem.parts[0].cut.outputs.shape[1:]
    cosines = np.cos(np.pi * np.outer(np.arange(COSINES), np.arange(L) + 0.5) / L)  # (K, L)
    along, norms = np.zeros((COSINES, ny)), np.zeros((COSINES, ny))
    squares, readings, windows = np.zeros(ny), np.zeros(ny), 0
    for t in fit.tangents:
        W = len(t.r)
        U = (t.U * (t.s > 0)[:, None])[:, : L * ny].reshape(W, L, ny, -1)
        r = t.projected[1][:, : L * ny].reshape(W, L, ny)
        along += np.sum(np.einsum("kl,wly->wky", cosines, r) ** 2, axis=0)
        lost = np.sum(np.einsum("kl,wlyx->wkyx", cosines, U) ** 2, axis=(0, 3))
        norms += W * np.sum(cosines**2, axis=1)[:, None] - lost
        squares += np.sum(r**2, axis=(0, 1))
        readings += W * L - np.sum(U**2, axis=(0, 1, 3))
        windows += W
    usual = squares / readings
    slow = np.divide(along, norms, out=np.zeros_like(along), where=norms > LEAST_NORM * L * windows)
    return usual, np.maximum(usual, slow.max(axis=0)), readings / windows
