"""The state at the start of each window that explains it best, the parameters held.

    min over d_w of ‖(y_w - ŷ_w(x̄_w ⊕ d_w))/s‖² + ‖d_w/s_x‖²           each window by itself

Levenberg and Marquardt with a damping of its own for each window: where a joint sticks, its first
rate is hardly felt. Parent and child are compared from states found in this one way.
"""

from __future__ import annotations

import numpy as np

from identification.errors import DivergenceError
from identification.estimation.shooting import Shooting, tangent

STEPS = 20  # at most
ENDED = 1e-3  # of the mean squared error: a window that changes by less is at its best
FIRST_DAMPING, MOST_DAMPING = 1e-9, 1e2  # of the squared norms of X's columns


def smoothed(shooting: Shooting, moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The best moves of the windows' states, and the errors that they leave.

    Args:
        shooting: windows of a model of which no parameter is free.
        moves: where the search begins, shape (W, nx).

    Returns:
        Moves (W, nx) and errors (W, L, ny) in the outputs' units.

    Raises:
        DivergenceError: the start cannot be simulated.
    """
    none, d = np.zeros(0), moves
    at = tangent(shooting, none, d)
    damping = np.full(len(d), FIRST_DAMPING)
    for _ in range(STEPS):
        before = np.sum(at.r**2, axis=1)
        along = np.einsum("wmk,wm->wk", at.U, at.r) * at.s / (at.s**2 + damping[:, None])
        trial = d + np.einsum("wkx,wk->wx", at.Vt, along) / at.size
        try:
            after = np.sum(shooting.residual(none, trial) ** 2, axis=1)
        except DivergenceError:
            after = np.full(len(d), np.inf)
        better = after < before
        damping = np.where(better, np.maximum(damping / 10, FIRST_DAMPING), 10 * damping)
        d = np.where(better[:, None], trial, d)
        small = np.abs(after - before) <= ENDED * before.mean()
        if np.all(small | (damping > MOST_DAMPING)):
            break
        at = tangent(shooting, none, d)
    return d, shooting.error(shooting.residual(none, d))
