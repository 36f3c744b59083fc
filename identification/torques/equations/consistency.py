"""Are there bodies that have the base parameters as fitted? (Wensing, Kim, Slotine 2018.)

    min Σ_k ((K x - β)_k / σ_k)²   over   P_b = [½ tr I 1 - I, h; hᵀ, m] ⪰ 0,  armatures ≥ 0

A body has ten numbers exactly if its pseudo-inertia P is positive semidefinite. The problem is
convex, and is solved by Douglas and Rachford's splitting (Eckstein, Bertsekas 1992), whose steps
are a linear equation and a cut of negative eigenvalues. What is left of a base parameter, in its
std, says whether some bodies have it: no value is pinned, and inertias that nothing feels are free.
"""

from __future__ import annotations

import numpy as np

from identification.torques.equations.base import BaseParameters
from identification.torques.equations.bodies import SIX

STEPS = 2000
LEFT = 3.0  # std of a base parameter that no bodies have
CLOSE = 0.5  # std, below which the search ends
_ROWS, _COLUMNS = np.triu_indices(4)
_TWICE = np.where(_ROWS == _COLUMNS, 1.0, np.sqrt(2.0))  # so that norms of vectors are Frobenius'


def find_inconsistent(base: BaseParameters, β: np.ndarray, std: np.ndarray) -> tuple[int, ...]:
    """Returns places of the base parameters that no bodies have, within 3 std.

    β are their fitted values, with `std`, each of shape (r,).
    """
    inertia, n = base.inertia, base.inertia.bodies
    at = np.argsort(inertia.place)  # the numbers of each body in turn, then the armatures
    to_numbers = np.kron(np.eye(n), _TO_NUMBERS)
    scale, first = inertia.own[at], 10 * n
    A = base.K[:, at] * scale / std[:, None]
    A[:, :first] = A[:, :first] @ to_numbers
    z = inertia.values[at] / scale
    z[:first] = np.linalg.solve(to_numbers, z[:first])
    left = A @ _nearest(A, β / std, z, n) - β / std
    return tuple(np.flatnonzero(np.abs(left) > LEFT).tolist())


def nearest_body(K: np.ndarray, β: np.ndarray, std: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Returns the combinations K x of a body's ten numbers that are nearest to values β (r,).

    `std` are those of the values, and `scale` is how large the numbers are, roughly, shape (10,).
    """
    A = (K * scale) @ _TO_NUMBERS / std[:, None]
    return np.asarray(A @ _nearest(A, β / std, np.zeros(10), 1) * std)


def _nearest(A: np.ndarray, b: np.ndarray, z: np.ndarray, n: int) -> np.ndarray:
    """Returns entries u of n pseudo-inertias, and armatures, that leave least of A u - b."""
    U, s, Vt = np.linalg.svd(A, full_matrices=False)
    for _ in range(STEPS):
        y = z - Vt.T @ (s / (1 + s**2) * (U.T @ (A @ z - b)))
        u = _cut(2 * y - z, n)
        z = z + u - y
        if np.abs(A @ u - b).max() < CLOSE:
            break
    return u


def _numbers(y: np.ndarray) -> np.ndarray:
    """Returns the ten numbers of a body of the entries of its pseudo-inertia, shape (10,)."""
    P = np.zeros((4, 4))
    P[_ROWS, _COLUMNS] = P[_COLUMNS, _ROWS] = y / _TWICE
    I_O = np.trace(P[:3, :3]) * np.eye(3) - P[:3, :3]
    return np.array([P[3, 3], *P[:3, 3], *I_O[SIX]])


_TO_NUMBERS = np.array([_numbers(e) for e in np.eye(10)]).T


def _cut(y: np.ndarray, bodies: int) -> np.ndarray:
    """Returns the nearest pseudo-inertias and armatures that are not negative."""
    out = np.maximum(y, 0.0)
    entries = y[: 10 * bodies].reshape(bodies, 10) / _TWICE
    P = np.zeros((bodies, 4, 4))
    P[:, _ROWS, _COLUMNS] = P[:, _COLUMNS, _ROWS] = entries
    w, V = np.linalg.eigh(P)
    P = (V * np.maximum(w, 0.0)[:, None, :]) @ np.swapaxes(V, 1, 2)
    out[: 10 * bodies] = (P[:, _ROWS, _COLUMNS] * _TWICE).ravel()
    return out
