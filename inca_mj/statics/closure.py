"""Wrench closure and feasibility: whether the cables can hold any wrench, or a set of them.

    closure  ⇔  rank W = 6  and  there is T > 0 with W T = 0

Rank 6 alone is not enough. With two cables of one vertical edge on one connector, W has rank 6 and
a good condition number, and every solution of W T = 0 has a cable that would have to push.

At one pose, a linear program finds the largest margin t with W T = 0, t ≤ T ≤ 1: the smallest over
the largest tension of the best internal tension. There is closure where t > 0. Over many poses the
null space, which has two dimensions, decides without a solver. With N an orthonormal basis and n_i
its rows,

    there is λ with N λ > 0  ⇔  all n_i lie in an open half plane
                             ⇔  the largest gap between neighbouring directions exceeds π.

Within tension limits, T = W⁺ w + N λ, a wrench w is feasible if some λ satisfies 16 linear
inequalities. In the plane they have a common solution exactly if every three of them have one
(Helly). For cables i < j < k the combination that removes λ is

    y_i = n_j × n_k,   y_j = n_k × n_i,   y_k = n_i × n_j,   all other y = 0,   |y| = 1,

and with h(y) = Σ max(y low, y high), the largest yᵀ T within the limits, w is feasible exactly if

    yᵀ W⁺ w ≤ h(y)   for all 56 y and their negatives.

These are the facets of the zonotope of all wrenches. All wrenches of a set are feasible exactly if
the support of the set, the largest yᵀ W⁺ w over it, obeys the inequality. The set here is the load,
plus any force up to f, plus any torque up to τ:

    support(y) = cᵀ w₀ + f |c_force| + τ |c_torque|,   c = W⁺ᵀ y

Sources: Verhoeven 2004, Analysis of the workspace of tendon-based Stewart platforms; Gouttefarde,
Gosselin 2006, Analysis of the wrench-closure workspace of planar parallel cable-driven mechanisms;
Bouchard, Gosselin, Moore 2010, On the ability of a cable-driven robot to generate a prescribed set
of wrenches.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.optimize import linprog

from identification.errors import InputError
from inca_mj.robot.geometry import DRIVES

TRIPLES = np.array(list(combinations(range(DRIVES), 3)))
AT_ONCE = 1000  # poses whose arrays stay in the processor's cache
LEAST = 1e-12  # a combination of less is that of parallel rows, and says nothing
RANK = 1e-9  # a singular value this far below the largest is zero
POSITIVE = 1e-6  # a margin of less is none: the solver keeps equations to 1e-7
NOTHING = 1e-9  # a row of the null space of less is zero


@dataclass(frozen=True)
class Closure:
    """Rank, condition and internal tension of the cables at one pose."""

    rank: int  # of the wrench matrix, 6 where the cables move the platform in every direction
    # its largest over its smallest singular value, lengths in metres; infinite below rank 6
    condition: float
    margin: float  # smallest over largest tension of the best internal tension; 0 without closure
    # that internal tension, largest 1, shape (8,), relative; all zero without closure
    tensions: np.ndarray

    @property
    def closed(self) -> bool:
        """Tells whether every wrench can be exerted with enough tension."""
        return self.rank == 6 and self.margin > POSITIVE


def closure(W: np.ndarray) -> Closure:
    """Returns rank and closure of a wrench matrix W, shape (6, n) [-, m], by a linear program."""
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
    """Refuses a pose whose rank is below 6, or whose cables do not pull against each other."""
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
    """Returns W⁺ (N, 8, 6), null spaces (N, 8, 2) and whether the rank is 6, by Wᵀ = Q [L; 0].

    Below rank 6, W⁺ is NaN and the basis a part of the null space. Column k of Wᵀ lies in the span
    of those before it exactly if L_kk = 0, so the diagonal of L says whether the rank is 6.
    """
    Q, L = np.linalg.qr(np.swapaxes(W, 1, 2), mode="complete")
    L = L[:, :6]
    diagonal = np.abs(np.diagonal(L, axis1=1, axis2=2))
    full = diagonal.min(axis=1) > RANK * diagonal.max(axis=1)
    inverse = np.full_like(L, np.nan)
    inverse[full] = np.linalg.inv(L[full])
    return Q[:, :, :6] @ np.swapaxes(inverse, 1, 2), Q[:, :, 6:], full


def gap_margin(N: np.ndarray, full: np.ndarray) -> np.ndarray:
    """Returns by how much the free sector of null spaces exceeds a half plane, shape (N,) [rad].

    Positive where there is closure; −π below rank 6. It goes through zero continuously where the
    rank is 6, so the border of the workspace can be interpolated.
    """
    angle = np.sort(np.arctan2(N[..., 1], N[..., 0]), axis=1)
    gap = np.diff(angle, axis=1, append=angle[:, :1] + 2 * np.pi).max(axis=1)
    lost = (np.linalg.norm(N, axis=2).min(axis=1) < NOTHING) | ~full
    return np.where(lost, -np.pi, gap - np.pi)


def wrench_margin(
    plus: np.ndarray, N: np.ndarray, full: np.ndarray, low: np.ndarray, high: np.ndarray,
    load: np.ndarray, force: float = 0.0, torque: float = 0.0,
) -> np.ndarray:  # fmt: skip
    """Returns how far the worst wrench of a set is inside what cables can exert, shape (N,) [N].

    Positive: all wrenches of the set are feasible; the number is a tension, because y has norm 1.
    Negative: some wrench is not. −∞ below rank 6. The first three arguments are those of `split`;
    the tension limits have shape (8,) or (N, 8) [N]. The set is `load` (6,) in O [N, N m], with any
    additional force [N] and torque [N m] up to these sizes.
    """
    low, high = (np.broadcast_to(limit, (len(N), DRIVES)) for limit in (low, high))
    margin = np.full(len(N), -np.inf)
    possible = np.flatnonzero(full & (low <= high).all(axis=1))
    for part in np.array_split(possible, len(possible) // AT_ONCE + 1):
        margin[part] = _margin(plus[part], N[part], low[part], high[part], load, force, torque)
    return margin


def _margin(
    plus: np.ndarray, N: np.ndarray, low: np.ndarray, high: np.ndarray,
    load: np.ndarray, force: float, torque: float,
) -> np.ndarray:  # fmt: skip
    i, j, k = TRIPLES.T
    y = np.stack([_across(N, j, k), _across(N, k, i), _across(N, i, j)])  # (3, N, 56)
    size = np.sqrt((y * y).sum(axis=0))
    y = np.divide(y, size, where=size > LEAST, out=np.zeros_like(y))
    T = plus @ load
    middle = sum(part * T[:, at] for part, at in zip(y, (i, j, k), strict=True))
    reach = np.zeros_like(size)
    for extent, axes in ((force, slice(0, 3)), (torque, slice(3, 6))):
        if extent:
            c = sum(
                part[..., None] * plus[:, at, axes] for part, at in zip(y, (i, j, k), strict=True)
            )
            reach += extent * np.linalg.norm(c, axis=2)
    ends = [(part * low[:, at], part * high[:, at]) for part, at in zip(y, (i, j, k), strict=True)]
    above = sum(np.maximum(a, b) for a, b in ends) - middle - reach
    below = middle - sum(np.minimum(a, b) for a, b in ends) - reach
    return np.where(size > LEAST, np.minimum(above, below), np.inf).min(axis=1)


def _across(N: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Returns n_a × n_b of pairs of rows, shape (N, 56)."""
    return N[:, a, 0] * N[:, b, 1] - N[:, a, 1] * N[:, b, 0]
