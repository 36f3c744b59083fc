"""Transitions of many small linear systems at once, from a series.

    ẋ = F x + g  over Δt:    x ← A x + Γ g,    X = F Δt
    φ(X) = Σ_k X^k/(k+1)!,    A = e^X = I + X φ(X),    Γ = Δt φ(X)
    φ(2X) = φ(X) (2 I + X φ(X))/2                              (Moler, Van Loan 2003, method 3)

The series is taken where no X is longer than `LONGEST`, and doubled from there. `scipy.linalg.expm`
takes the matrices one by one, which for a robot with a few states is most of a linearisation.
"""

from __future__ import annotations

import numpy as np

LONGEST = 0.5  # 1-norm; 0.5^15/16! is below the rounding of doubles
TERMS = 14


def transitions(F: np.ndarray, duration: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The transition of a linear system, and the effect of a constant rate of change.

    Args:
        F: shape (n, nx, nx) [1/s].
        duration: shape (n,) [s].

    Returns:
        A and Γ, both of shape (n, nx, nx).
    """
    X, one = F * duration[:, None, None], np.eye(F.shape[1])
    longest = np.abs(X).sum(axis=1).max(initial=0.0)
    is_long = LONGEST < longest < np.inf  # what is not finite gives NaN
    doublings = int(np.ceil(np.log2(longest / LONGEST))) if is_long else 0
    X = X / 2**doublings
    φ = np.broadcast_to(one, X.shape)
    for k in range(TERMS, 0, -1):  # φ = I + X/2 (I + X/3 (I + …))
        φ = one + X @ φ / (k + 1)
    for _ in range(doublings):
        φ, X = φ @ (one + X @ φ / 2), 2 * X
    return one + X @ φ, duration[:, None, None] * φ
