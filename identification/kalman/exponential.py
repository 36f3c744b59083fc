"""Transitions of many small linear systems at once, from a series.

    ẋ = F x + g  over Δt:    x ← A x + Γ g,    X = D⁻¹ F Δt D
    φ(X) = Σ_k X^k/(k+1)!,    A = e^X = I + X φ(X),    Γ = Δt φ(X)
    φ(2X) = φ(X) (2 I + X φ(X))/2                              (Moler, Van Loan 2003, method 3)

D balances the states' units by powers of two, which rounds nothing (Parlett, Reinsch 1969): an
elastic cable in metres beside angles makes a matrix of norm 1e5, whose doublings cost more than all
else; balanced it is 10. The series is taken where no X is longer than `LONGEST`, and doubled from
there. Its polynomial is taken in groups of four powers (Paterson, Stockmeyer 1973), with 6 products
of matrices in place of 14. `scipy.linalg.expm` takes the matrices one by one, which for a robot
with a few states is most of a linearisation.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from scipy.linalg import matrix_balance

from identification.pool import run_parts, split

LONGEST = 0.5  # 1-norm; 0.5^15/16! is below the rounding of doubles
GROUP, GROUPS = 4, 4
SERIES = np.array([1 / factorial(k + 1) for k in range(GROUP * GROUPS)]).reshape(GROUPS, GROUP)
TOGETHER = 32  # matrices whose products stay in a processor's own cache


def transitions(F: np.ndarray, duration: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The transition of a linear system, and the effect of a constant rate of change.

    Args:
        F: shape (n, nx, nx) [1/s].
        duration: shape (n,) [s].

    Returns:
        A and Γ, both of shape (n, nx, nx).
    """
    with np.errstate(over="ignore", invalid="ignore"):  # what grows beyond all numbers is inf
        X = F * duration[:, None, None]
        D = _balance(X)
    back = D[:, None] / D
    A, Γ = np.empty_like(X), np.empty_like(X)

    def part(some: slice) -> None:
        with np.errstate(over="ignore", invalid="ignore"):
            A[some], φ = _exponential(X[some] * back.T)
            A[some] *= back
            Γ[some] = duration[some, None, None] * φ * back

    run_parts(part, split(len(X), TOGETHER))
    return A, Γ


def _balance(X: np.ndarray) -> np.ndarray:
    """D of all matrices together, shape (nx,)."""
    largest = np.abs(X).max(axis=0, initial=0.0)
    if not np.isfinite(largest).all() or not largest.size:  # what is not finite stays so
        return np.ones(len(largest))
    _, (D, _) = matrix_balance(largest, permute=False, separate=True)
    return np.asarray(D)


def _exponential(X: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """e^X and φ(X) of matrices X, shape (n, nx, nx)."""
    one = np.eye(X.shape[1])
    longest = np.abs(X).sum(axis=1).max(initial=0.0)
    is_long = LONGEST < longest < np.inf
    doublings = int(np.ceil(np.log2(longest / LONGEST))) if is_long else 0
    X = X / 2**doublings
    X2 = X @ X
    X3, X4 = X2 @ X, X2 @ X2
    *lower, φ = (c[0] * one + c[1] * X + c[2] * X2 + c[3] * X3 for c in SERIES)
    for group in reversed(lower):
        φ = group + X4 @ φ
    for _ in range(doublings):
        φ, X = φ @ (one + X @ φ / 2), 2 * X
    return one + X @ φ, φ
