"""The moments of candidates' columns with those of a fit, by blocks.

    M_b = (Φ, S, y)_bᵀ W (Φ, S, y)_b        Φ: columns of the fit, S: of a candidate, W: weights

Sums of squares of any blocks, with sizes fitted to any others, follow from them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from identification.torques.equations.equations import Columns, Equations, Estimate, unseen_squares
from identification.torques.laws import Missing


@dataclass(frozen=True, kw_only=True)
class Base:
    """A fit to which candidates are added."""

    Φ: np.ndarray  # columns, shape (N, nv, p)
    y: np.ndarray  # right side, shape (N, nv)
    P: np.ndarray  # precision of the priors, shape (p,)
    θ_0: np.ndarray  # their means, shape (p,)
    fit: Estimate  # of these
    M: np.ndarray  # moments of (Φ, y), shape (nv, B, p + 1, p + 1)
    known: int = 0  # number of sizes, the first ones, that are free with what was known of them

    @property
    def far(self) -> np.ndarray:
        """Free sizes less what was known of them, in its std, shape (known,)."""
        off = (self.fit.θ - self.θ_0) * np.sqrt(self.P)
        return np.asarray(off[: self.known])

    def unseen(self, confirms: np.ndarray) -> np.ndarray:
        """Returns `unseen_squares` of the fit; nothing is fitted to blocks that confirm."""
        return unseen_squares(self.M, self.fit.weights, self.P, self.θ_0, confirms)


class Weighted:
    """The fit's columns and right side with their weights, joint by joint."""

    def __init__(self, equations: Equations, base: Base) -> None:
        rest = np.concatenate([base.Φ, base.y[:, :, None]], axis=2)
        self.weight = np.sqrt(base.fit.weights) * equations.stacked("used")
        weighted = rest * self.weight[:, :, None]
        self.whole = weighted.reshape(-1, rest.shape[2])
        self.each = [np.ascontiguousarray(weighted[:, j]) for j in range(equations.joints)]
        self.edges = np.searchsorted(equations.block, np.arange(len(equations.record) + 1))

    def moments(self, columns: Columns) -> tuple[np.ndarray, np.ndarray] | None:
        """Returns moments of columns with the fit's (B, p + 1, m), and with themselves (B, m, m).

        None where one of them is zero.
        """
        x = columns.values * self.weight[:, :, None]
        if columns.joints is not None and len(columns.joints) == 1:
            (j,) = columns.joints
            rest, x, times = self.each[j], x[:, j], 1
        else:
            rest, x, times = self.whole, x.reshape(-1, x.shape[2]), len(self.each)
        if not x.any(axis=0).all():
            return None
        blocks = [slice(times * a, times * b) for a, b in pairwise(self.edges.tolist())]
        cross = np.array([rest[some].T @ x[some] for some in blocks])
        return cross, np.array([x[some].T @ x[some] for some in blocks])


def joined(G: np.ndarray, cross: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Returns moments of (Φ, S, y), shape (B, p + m + 1, p + m + 1)."""
    p, m = G.shape[1] - 1, own.shape[1]
    out = np.empty((len(G), p + m + 1, p + m + 1))
    out[:, :p, :p], out[:, -1, -1] = G[:, :-1, :-1], G[:, -1, -1]
    out[:, :p, -1] = out[:, -1, :p] = G[:, :-1, -1]
    out[:, :p, p:-1], out[:, p:-1, p:-1] = cross[:, :-1], own
    out[:, p:-1, :p] = np.swapaxes(cross[:, :-1], 1, 2)
    out[:, p:-1, -1] = out[:, -1, p:-1] = cross[:, -1]
    return out


def held_by(missing: Missing, own: np.ndarray) -> np.ndarray:
    """Returns the precisions that hold sizes with the moments `own` (B, m, m) at zero, (m,)."""
    ridges = np.array(missing.ridges or [0.0] * len(missing.sizes))
    if not ridges.any():
        return ridges
    return np.asarray(ridges * np.einsum("bmm->bm", own).sum(axis=0)[ridges > 0].mean())
