"""Least squares with bounds on some unknowns, where most unknowns have none.

    min ‖A x - b‖²,  low ≤ x ≤ high                A = Q R,  Qᵀ b = c:  min ‖R x - c‖², R square
    R_f z + R_b y = c,  z without bounds  ->  min ‖P (R_b y - c)‖² over y,   P = I - R_f R_f⁺

Of a long chain of bodies many columns are nearly sums of others. Unknowns that hardly change what
is left are then huge without their bounds, where a solver of bounds begins, and it does not come
back. So they are held by a weak pull to zero.

A solver of bounds takes the square of its rows and columns in each of its many steps, and an
unknown without bounds needs none of them: it follows from the others.
"""

from __future__ import annotations

import numpy as np

# Share of the largest diagonal of R below which a column is a sum of the others, to rounding.
DEPENDENT = 1e-10
PULL = 1e-4  # of an unknown, that it adds to what is left; columns are of a size of one, or more


def solve_bounded(A: np.ndarray, b: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Computes the unknowns within their bounds that leave least of b, shape (n,).

    Args:
        A: shape (m, n), its columns of a like size.
        b: shape (m,).
        low: shape (n,), -inf for no bound.
        high: shape (n,), inf for no bound.
    """
    from scipy.linalg import qr  # slow to import
    from scipy.optimize import lsq_linear

    R, c = _triangle(A, b)
    is_free = np.isinf(low) & np.isinf(high)
    bounded = ~is_free
    Q, T, order = qr(R[:, is_free], pivoting=True)
    size = np.abs(np.diag(T))
    rank = int(np.sum(size > DEPENDENT * size.max(initial=0.0)))
    turned, goal = Q.T @ R[:, bounded], Q.T @ c
    x = np.zeros(A.shape[1])
    if bounded.any():
        n = turned.shape[1]
        pulled = np.vstack([turned[rank:], PULL * np.eye(n)])
        small, rest = _triangle(pulled, np.append(goal[rank:], np.zeros(n)))
        x[bounded] = lsq_linear(small, rest, (low[bounded], high[bounded])).x
    z = np.zeros(int(is_free.sum()))
    if rank:
        from scipy.linalg import solve_triangular

        z[order[:rank]] = solve_triangular(
            T[:rank, :rank], goal[:rank] - turned[:rank] @ x[bounded]
        )
    x[is_free] = z
    return x


def _triangle(A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns R and Qᵀ b of A = Q R, or A and b where they have no more rows than columns."""
    if len(A) <= A.shape[1]:
        return A, b
    both: np.ndarray = np.linalg.qr(np.column_stack([A, b]), mode="r")  # type: ignore[assignment]
    return both[:, :-1], both[:, -1]
