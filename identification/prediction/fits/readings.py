"""How many independent readings the windows of a fit hold, by output.

    v_ky = Σ_w (d_kᵀ r⊥_wy)² / Σ_w ‖d_k⊥w‖²        mean square of errors along d_k
    n_y = max(1, ν_y σ_y²/max(σ_y², max_k v_ky))     of ν_y = L - Σ‖U_y‖² readings of a window

d_k are the slowest cosines over a window, as whatever a missing force makes is slow; r⊥ and d_k⊥:
errors and cosines without what the state of the window makes up for; σ_y²: mean square of the
errors of output y over all readings. Where errors are those of a sensor, no direction has more than
another, and every reading counts. Where a window is wrong as a whole, as by an error of its input,
they lie along few of these directions, and the window is one reading or two.
"""

from __future__ import annotations

import numpy as np

from identification.windows.fit import WindowFit

COSINES = 5  # of them the state makes up for two or so


def independent_readings(fit: WindowFit) -> np.ndarray:
    """Returns the mean number of independent readings of each output in a window, shape (ny,).

    Args:
        fit: a model, fitted.
    """
    L, ny = fit.problem.parts[0].cut.outputs.shape[1:]
    cosines = np.cos(np.pi * np.outer(np.arange(COSINES), np.arange(L) + 0.5) / L)  # (K, L)
    along, norms = np.zeros((COSINES, ny)), np.zeros((COSINES, ny))
    squares, readings, windows = np.zeros(ny), np.zeros(ny), 0
    for t in fit.tangents:
        W, rows = len(t.r), L * ny
        U = (t.U * (t.s > 0)[:, None])[:, :rows].reshape(W, L, ny, -1)
        r = t.projected[1][:, :rows].reshape(W, L, ny)
        along += np.einsum("kwy->ky", np.einsum("kl,wly->kwy", cosines, r) ** 2)
        lost = np.einsum("kl,wlyx->kwyx", cosines, U) ** 2
        norms += W * np.sum(cosines**2, axis=1)[:, None] - lost.sum(axis=(1, 3))
        squares += np.sum(r**2, axis=(0, 1))
        readings += W * L - np.sum(U**2, axis=(0, 1, 3))
        windows += W
    usual = np.divide(squares, readings, out=np.ones(ny), where=squares > 0)
    is_left = norms > 1e-3 * L  # else the states make up for it
    largest = np.max(np.divide(along, norms, out=np.zeros_like(along), where=is_left), axis=0)
    share = usual / np.maximum(usual, largest)
    return np.asarray(np.maximum(1.0, share * readings / windows))
