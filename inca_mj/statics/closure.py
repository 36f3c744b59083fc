"""Wrench closure: whether the cables can pull against each other, and so hold any wrench.

    closure  ⇔  rank W = 6  and  there is T > 0 with W T = 0

Rank 6 alone is not enough. With two cables of one vertical edge on one connector, W has rank 6 and
a good condition number, and every solution of W T = 0 has a cable that would have to push.

At one pose, a linear program finds the largest margin t with W T = 0, t ≤ T ≤ 1: the
smallest over the largest tension of the best internal tension. There is closure where t > 0. Over
many poses the null space, which has two dimensions, decides without a solver. With N an
orthonormal basis and n_i its rows,

    there is λ with N λ > 0  ⇔  all n_i lie in an open half plane
                             ⇔  the largest gap between neighbouring directions exceeds π.

Sources: Verhoeven 2004, Analysis of the workspace of tendon-based Stewart platforms; Gouttefarde,
Gosselin 2006, Analysis of the wrench-closure workspace of planar parallel cable-driven mechanisms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from identification.errors import InputError

RANK = 1e-9  # a singular value this far below the largest is zero
POSITIVE = 1e-6  # a margin of less is none: the solver keeps equations to 1e-7
NOTHING = 1e-9  # a row of the null space of less is zero


@dataclass(frozen=True)
class Closure:
    """Rank, condition and internal tension of the cables at one pose.

    Attributes:
        rank: of the wrench matrix, 6 where the cables move the platform in every direction.
        condition: its largest over its smallest singular value, lengths in metres; infinite below
            rank 6.
        margin: smallest over largest tension of the best internal tension; 0 without closure.
        tensions: that internal tension, largest 1, shape (8,), relative; all zero without closure.
    """

    rank: int
    condition: float
    margin: float
    tensions: np.ndarray

    @property
    def closed(self) -> bool:
        """Whether every wrench can be exerted with enough tension."""
        return self.rank == 6 and self.margin > POSITIVE


def closure(W: np.ndarray) -> Closure:
    """Returns the rank and closure of a wrench matrix, by a linear program.

    Args:
        W: wrench of the cables on the platform per tension, shape (6, n) [-, m].
    """
    s = np.linalg.svd(W, compute_uv=False)
    n, rank = W.shape[1], int((s > RANK * s[0]).sum())
    condition = float(s[0] / s[-1]) if rank == len(W) else float("inf")
    # unknowns (T, t): the largest t with T_i - t >= 0
    found = linprog(
        np.r_[np.zeros(n), -1.0],
        A_ub=np.hstack([-np.eye(n), np.ones((n, 1))]),
        b_ub=np.zeros(n),
        A_eq=np.hstack([W, np.zeros((len(W), 1))]),
        b_eq=np.zeros(len(W)),
        bounds=[(0.0, 1.0)] * (n + 1),
        method="highs",
    )
    T = found.x[:n]
    T = T - np.linalg.pinv(W) @ (W @ T)  # to rounding
    if T.min() <= POSITIVE:
        return Closure(rank, condition, 0.0, np.zeros(n))
    return Closure(rank, condition, float(T.min() / T.max()), T / T.max())


def require_closure(found: Closure, pose: np.ndarray) -> None:
    """Refuse a pose without closure.

    Args:
        found: what the cables span there.
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,).

    Raises:
        InputError: the rank is below 6, or it is 6 and the cables do not pull against each other.
    """
    at = np.round(pose, 4).tolist()
    if found.rank < 6:
        raise InputError(
            f"the cables have rank {found.rank} of 6 at pose {at}: there is a motion that none of"
            " them hinders; move the platform, or spread the connectors"
        )
    if not found.closed:
        raise InputError(
            f"the cables have rank 6 without closure at pose {at}: they cannot all pull against"
            " each other, so no tension holds every wrench; cross the cables (see docs/statics.md),"
            " or move the platform towards the middle"
        )


def split(W: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns pseudo-inverses, null spaces and ranks of many wrench matrices, by Wᵀ = Q [L; 0].

    Column k of Wᵀ lies in the span of those before it exactly if L_kk = 0, so the diagonal of L
    says whether the rank is 6.

    Args:
        W: shape (N, 6, 8) [-, m].

    Returns:
        W⁺, shape (N, 8, 6), NaN below rank 6; an orthonormal basis of the null space, shape
        (N, 8, 2), which is a part of it below rank 6; whether the rank is 6, shape (N,).
    """
    Q, L = np.linalg.qr(np.swapaxes(W, 1, 2), mode="complete")
    L = L[:, :6]
    diagonal = np.abs(np.diagonal(L, axis1=1, axis2=2))
    full = diagonal.min(axis=1) > RANK * diagonal.max(axis=1)
    inverse = np.full_like(L, np.nan)
    inverse[full] = np.linalg.inv(L[full])
    return Q[:, :, :6] @ np.swapaxes(inverse, 1, 2), Q[:, :, 6:], full


def gap_margin(N: np.ndarray, full: np.ndarray) -> np.ndarray:
    """Returns by how much the free sector of the null space exceeds a half plane [rad], shape (N,).

    Positive where there is closure. It goes through zero continuously where the rank is 6, so the
    border of the workspace can be interpolated.

    Args:
        N: bases of the null spaces, shape (N, 8, 2), without unit.
        full: whether the rank is 6, shape (N,) of bool; else there is no closure, margin −π.
    """
    angle = np.sort(np.arctan2(N[..., 1], N[..., 0]), axis=1)
    gap = np.diff(angle, axis=1, append=angle[:, :1] + 2 * np.pi).max(axis=1)
    lost = (np.linalg.norm(N, axis=2).min(axis=1) < NOTHING) | ~full
    return np.where(lost, -np.pi, gap - np.pi)
