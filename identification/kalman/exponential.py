"""Transitions of many small linear systems at once, from a series.

    ẋ = F x + g  over Δt:    x ← A x + Γ g,    X = D⁻¹ F Δt D
    φ(X) = Σ_k X^k/(k+1)!,    A = e^X = I + X φ(X),    Γ = Δt φ(X)
    φ(2X) = (φ(X) + e^X φ(X))/2,    e^2X = (e^X)²              (Moler, Van Loan 2003, method 3)

D balances the states' units by powers of two, which rounds nothing (Parlett, Reinsch 1969): an
elastic cable in metres beside angles makes a matrix of norm 1e5, whose doublings cost more than all
else; balanced it is 10. The series is taken where no X is longer than `LONGEST`, and doubled from
there. How long a matrix is for a series tell its powers, |X⁴|^¼ and |X⁵|^⅕ (Al-Mohy, Higham 2009,
theorem 4.2), of oscillations less than half its norm. The polynomial is taken in groups of five
powers (Paterson, Stockmeyer 1973), with 8 products of matrices in place of 23.
`scipy.linalg.expm` takes the matrices one by one, which for a robot with a few states is most of a
linearisation.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from scipy.linalg import matrix_balance

from identification.pool import run_parts, split

LONGEST = 2.8  # 2.8^25/26! is below the rounding of doubles
GROUP = 5
SERIES = np.array([1 / factorial(k + 1) for k in range(GROUP**2)]).reshape(GROUP, GROUP)
TOGETHER = 16  # matrices whose powers stay in a processor's own cache


def transitions(
    F: np.ndarray, duration: np.ndarray, forced: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """The transition of a linear system, and the effect of a constant rate of change.

    Args:
        F: shape (n, nx, nx) [1/s].
        duration: shape (n,) [s].
        forced: index of the first state whose rate is forced.

    Returns:
        A, shape (n, nx, nx), and Γ, shape (n, nx, nx - forced).
    """
    with np.errstate(over="ignore", invalid="ignore"):  # what grows beyond all numbers is inf
        D = _balance(np.abs(F * duration[:, None, None]).max(axis=0, initial=0.0))
    back = D[:, None] / D
    A, Γ = np.empty(F.shape), np.empty((*F.shape[:2], F.shape[2] - forced))

    def part(some: slice) -> None:
        Δt = duration[some, None, None]
        with np.errstate(over="ignore", invalid="ignore"):
            A[some], φ = _exponential(F[some] * (back.T * Δt), forced)
            A[some] *= back
            np.multiply(φ, Δt * back[:, forced:], out=Γ[some])

    run_parts(part, split(len(F), TOGETHER))
    return A, Γ


def _balance(largest: np.ndarray) -> np.ndarray:
    """D of matrices whose entries have these largest sizes, shape (nx,)."""
    if not np.isfinite(largest).all() or not largest.size:  # what is not finite stays so
        return np.ones(len(largest))
    _, (D, _) = matrix_balance(largest, permute=False, separate=True)
    return np.asarray(D)


def _exponential(X: np.ndarray, forced: int) -> tuple[np.ndarray, np.ndarray]:
    """e^X and the last columns of φ(X), from `forced` on, of matrices X, shape (n, nx, nx)."""
    powers = np.empty((GROUP + 1, *X.shape))
    powers[0], powers[1] = np.eye(X.shape[1]), X
    for k in range(2, GROUP + 1):
        np.matmul(powers[k - 1], X, out=powers[k])
    long = np.abs(powers[-2:]).sum(axis=2).max(axis=(1, 2), initial=0.0)
    longest = max(long[0] ** (1 / (GROUP - 1)), long[1] ** (1 / GROUP))
    is_long = LONGEST < longest < np.inf
    doublings = int(np.ceil(np.log2(longest / LONGEST))) if is_long else 0
    if doublings:
        powers *= (0.5 ** (doublings * np.arange(GROUP + 1)))[:, None, None, None]
    groups = (SERIES @ powers[:-1].reshape(GROUP, -1)).reshape(GROUP, *X.shape)
    φ = groups[-1]
    for group in groups[-2::-1]:
        group += powers[-1] @ φ
        φ = group
    A = powers[0] + powers[1] @ φ
    φ = φ[:, :, forced:] / 2**doublings
    for _ in range(doublings):
        φ, A = φ + A @ φ, A @ A
    return A, φ
