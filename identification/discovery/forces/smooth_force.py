"""The yardstick of a name: how much of a residual any smooth force could explain.

    e ≈ S c,   S = (S_1 ... S_K)        S_k: outputs for forces at the nodes of a curve of a rate, a
                                        position, an input or a time of a joint
    ĉ_-f = (Σ_{b not in f} G_b + R)⁻¹ Σ_{b not in f} a_b,   G_b = S_bᵀS_b,   a_b = S_bᵀe_b
    R = diag(ρ_k h_k),   h_k = mean diag Σ_b G_b of curve k
    gain = max_ρ Σ_f 2 a_fᵀĉ_-f - ĉ_-fᵀ G_f ĉ_-f

The forces are an additive Gaussian process (Särkkä, Álvarez, Lawrence 2017) whose curves are known
at their nodes. Its scales ρ_k are chosen by what the force explains of blocks of samples that it
was not fitted to (Stone 1974), and not by its likelihood, because a residual in which physics is
missing is no white noise. A curve with an infinite ρ_k is none.

A law that is the missing one leaves little to a smooth force beside it:

    share = (V_0 - V_1)/(V_0 - V_1 + gain)      V_0, V_1: sums of squares without it and with it
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FOLDS = 10  # of neighbouring blocks
RIDGES = (np.inf, 10.0, 1.0, 0.1, 0.01, 1e-3, 1e-4)  # ρ that are tried
MUCH_LEFT = 1.5  # times the noise: from there a cause is asked beside smooth forces
MOST_LEFT = 0.5  # of what is above the noise: a cause that leaves more is none
MAX_SWEEPS = 3  # over the curves, in each of which every ρ is chosen beside the others


@dataclass(frozen=True)
class SmoothForce:
    """The best smooth force."""

    # fall of the sum of squares of each block, by a force that was not fitted to it, shape (B,)
    gains: np.ndarray
    ridges: np.ndarray  # ρ of each curve, shape (K,); infinite for one that explains nothing
    c: np.ndarray  # forces at all nodes, by all samples, shape (k,)
    left_out: np.ndarray  # the same without the blocks of each fold, shape (F, k)

    @property
    def gain(self) -> float:
        """Fall of the sum of squares of all blocks."""
        return float(self.gains.sum())


def find_smooth_force(G: np.ndarray, a: np.ndarray, nodes: Sequence[int]) -> SmoothForce:
    """Returns the additive smooth force that explains most of blocks that it was not fitted to.

    Args:
        G: of B blocks, shape (B, k, k).
        a: shape (B, k).
        nodes: number of nodes of each curve; their sum is k.
    """
    of = np.repeat(np.arange(len(nodes)), nodes)
    folds = np.array_split(np.arange(len(a)), min(FOLDS, len(a)))
    own = np.array([G[f].sum(axis=0) for f in folds])
    mine = np.array([a[f].sum(axis=0) for f in folds])
    every, b = own.sum(axis=0), mine.sum(axis=0)
    others, theirs = every - own, b - mine
    diagonal = np.diag(every)
    h = np.array([diagonal[of == k].mean() for k in range(len(nodes))])

    def fitted(H: np.ndarray, b: np.ndarray, ridges: np.ndarray) -> np.ndarray:
        """Returns ĉ for each of F normal equations, shape (F, k)."""
        c = np.zeros(b.shape)
        has = np.isfinite(ridges[of]) & (diagonal > 0)
        if has.any():
            R = np.diag(ridges[of[has]] * h[of[has]])  # all > 0: the sum below has an inverse
            c[:, has] = np.linalg.solve(H[:, has][:, :, has] + R, b[:, has, None])[..., 0]
        return c

    def gains_of(k: int, ridges: np.ndarray) -> np.ndarray:
        """Returns the gain by each ρ_k of RIDGES beside those of the other curves, shape (P,)."""
        felt = diagonal > 0
        at, rest = felt & (of == k), felt & (of != k) & np.isfinite(ridges[of])
        if not at.any():
            return np.zeros(len(RIDGES))
        A = others[:, rest][:, :, rest] + np.diag(ridges[of[rest]] * h[of[rest]])
        B = others[:, rest][:, :, at]
        X = np.linalg.solve(A, np.concatenate([B, theirs[:, rest, None]], axis=2))
        X, x = X[..., :-1], X[..., -1:]  # A⁻¹B, A⁻¹b
        λ, Q = np.linalg.eigh(others[:, at][:, :, at] - B.transpose(0, 2, 1) @ X)
        z = Q.transpose(0, 2, 1) @ (theirs[:, at, None] - B.transpose(0, 2, 1) @ x)
        c = np.zeros((*theirs.shape, len(RIDGES)))
        c[:, at] = Q @ (z / (λ[..., None] + h[k] * np.array(RIDGES)))  # zero for an infinite ρ
        c[:, rest] = x - X @ c[:, at]
        return np.asarray(np.sum(c * (2 * mine[..., None] - own @ c), axis=(0, 1)))

    best = np.full(len(nodes), np.inf)
    most = 0.0
    for _ in range(MAX_SWEEPS):
        before = most
        for k in range(len(nodes)):
            tried = gains_of(k, best)
            if tried.max() > most:
                best[k], most = RIDGES[int(tried.argmax())], float(tried.max())
        if not most > before:
            break
    gains, left_out = np.zeros(len(a)), fitted(others, theirs, best)
    for f, c in zip(folds, left_out, strict=True):
        gains[f] = 2 * a[f] @ c - (G[f] @ c) @ c
    return SmoothForce(gains, best, fitted(every[None], b[None], best)[0], left_out)


def explained_share(before: float, after: float, gain: float) -> float | None:
    """Returns the share of what any smooth force could explain that laws explain, 0 to 1.

    Args:
        before: sum of squares without the laws.
        after: with them.
        gain: of a smooth force beside them.

    Returns:
        None where there is nothing to explain.
    """
    explained = max(0.0, before - after)
    return explained / (explained + gain) if explained + gain > 0 else None


def takes_most(without: float, with_it: float, noise: float) -> bool:
    """Returns whether a cause takes away most of what smooth forces leave above the noise.

    Args:
        without: sum of squares that smooth forces leave without the cause.
        with_it: the same with it.
        noise: sum of squares that noise alone would make.
    """
    return with_it - noise <= MOST_LEFT * (without - noise)
