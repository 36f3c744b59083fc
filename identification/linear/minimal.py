"""The minimal realisation: states that no input reaches or no output feels are dropped.

The staircase of Rosenbrock and Van Dooren (IEEE Trans. Automatic Control 26, 1981) by orthogonal
matrices Q, which needs neither a stable system nor Gramians:

    Qᵀ B = [B₁; 0],   Qᵀ A Q = [A₁₁ A₁₂; A₂₁ A₂₂],   then the same of (A₂₂, A₂₁), until A₂₁ = 0

What is left beside the stairs is reached by no input. The dual, (Aᵀ, Cᵀ), gives what no output
feels. A rank counts singular values above `tolerance` times the norm of A, or of B, once the states
are scaled so that rows and columns of A are alike; each input and output is scaled to one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.linear.system import LinearSystem, balancing

TOLERANCE = 1e-8  # central differences of a stiff law are exact to about 1e-9 of its norm


@dataclass(frozen=True, kw_only=True)
class Minimal:
    """A minimal realisation.

    Attributes:
        system: the realisation; its states z are called z1, z2, …, zero at the operating point.
        unreached: how many states no input reaches.
        unfelt: how many of the others no output feels.
        to_states: δx = V δz for what inputs reach, V of shape (nx, nz), in the units of the states.
        tolerance: of the ranks.
    """

    system: LinearSystem
    unreached: int
    unfelt: int
    to_states: np.ndarray
    tolerance: float


def minimal(system: LinearSystem, tolerance: float = TOLERANCE) -> Minimal:
    """Drop what no input reaches and no output feels.

    Args:
        system: continuous or discrete.
        tolerance: below which share of the norm a singular value counts as zero.

    Raises:
        InputError: the tolerance is not between 0 and 1.
    """
    if not 0 < tolerance < 1:
        raise InputError(f"a tolerance of {tolerance:g} is not between 0 and 1; try {TOLERANCE:g}")
    scale = balancing(system.A)
    A, B, C = system.A * scale / scale[:, None], system.B / scale[:, None], system.C * scale
    V = stairs(A, _alike(B), tolerance)
    A, B, C = V.T @ A @ V, V.T @ B, C @ V
    W = stairs(A.T, _alike(C.T), tolerance)
    A, B, C = W.T @ A @ W, W.T @ B, C @ W
    n, r, m = len(system.A), V.shape[1], W.shape[1]
    small = LinearSystem(
        A=A, B=B, C=C, D=system.D, states=tuple(f"z{k + 1}" for k in range(m)),
        inputs=system.inputs, outputs=system.outputs, x=np.zeros(m), u=system.u, y=system.y,
        rate=W.T @ (V.T @ (system.rate / scale)), sampling_time=system.sampling_time,
    )  # fmt: skip
    return Minimal(
        system=small, unreached=n - r, unfelt=r - m, to_states=scale[:, None] * (V @ W),
        tolerance=tolerance,
    )  # fmt: skip


def stairs(A: np.ndarray, B: np.ndarray, tolerance: float) -> np.ndarray:
    """Returns an orthonormal basis of the states that inputs reach, shape (nx, reached), no unit.

    Args:
        A: shape (nx, nx), in alike units.
        B: shape (nx, nu), in alike units.
        tolerance: see the module.
    """
    Q, done = np.eye(len(A)), 0
    size = float(np.linalg.norm(A, 2))
    below, limit = B, tolerance * max(float(np.linalg.norm(B, 2)), np.finfo(float).tiny)
    while done < len(A) and below.size:
        U, s, _ = np.linalg.svd(below)
        rank = int((s > limit).sum())
        if rank == 0:
            break
        Q[:, done:] = Q[:, done:] @ U
        moved = Q.T @ A @ Q
        below = moved[done + rank :, done : done + rank]
        done, limit = done + rank, tolerance * size
    return Q[:, :done]


def _alike(B: np.ndarray) -> np.ndarray:
    """Returns the columns scaled to length one, but for those that are zero."""
    length = np.linalg.norm(B, axis=0)
    return np.asarray(B / np.where(length > 0, length, 1.0))
