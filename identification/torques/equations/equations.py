"""The equations of all records as moments of blocks, from which every fit and score follows.

    M_jb = Σ_k (X_jk, y_jk)ᵀ (X_jk, y_jk)       over the equations k of joint j in block b
    G_b = Σ_j w_j M_jb,   w_j = 1/(κ σ_j²)      σ_j: residual of the joint

    θ̂ = (Σ_b A_b + P)⁻¹ (Σ_b a_b + P θ_0)       A_b, a_b: parts of G_b, P = diag(1/s²): priors
    g_b = (1 - A_b H⁻¹)⁻¹ (a_b - A_b θ̂),        H = Σ_b A_b + P
    cov θ̂ = H⁻¹ (Σ_b g_b g_bᵀ + P) H⁻¹
    κ = Σ_b g_bᵀ H⁻¹ g_b / tr(Σ_b A_b H⁻¹)      1 where the residual is white

A block is longer than the memory of the residual, so that its std need no model of the noise: it is
the jackknife of blocks (Bell, McCaffrey 2002; Künsch 1989) beside the priors. κ is how much more
the sizes scatter than white noise would make them, so that equations that say the same do not
outweigh what was known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.torques.equations.base import all_columns, known_numbers
from identification.torques.equations.rows import Rows
from identification.torques.equations.smoothing import ATTENUATION

BLOCKS = 60  # at most, over all records
LASTS = 0.5  # shortest block [s]
ROUNDS = 6  # of weights
FOLDS = 10  # of neighbouring blocks
ROUNDING = 1e-13  # of a column that is a sum of others
NO_NOISE = 1e-9  # of a joint's largest torque, that the residual is at least


@dataclass(frozen=True)
class Columns:
    """Columns of the equations with a size each."""

    values: np.ndarray  # shape (N, nv, k)
    joints: tuple[int, ...] | None = None  # on which they act; on all where None


@dataclass(frozen=True)
class Equations:
    """The equations of all records, one behind the other."""

    rows: tuple[Rows, ...]  # of each record
    block: np.ndarray  # of each short time, shape (N,)
    record: np.ndarray  # of each block, shape (B,)
    confirms: np.ndarray  # whether nothing is fitted to a block, shape (B,)
    all_judge: bool = True  # whether blocks of fitted records judge too, by fits without them

    @classmethod
    def of(cls, rows: Sequence[Rows], confirm: int = 0) -> Equations:
        """Returns the equations of records, cut into blocks of about one length.

        Nothing is fitted to the last records, `confirm` of them.
        """
        spans = [float(r.time[-1] - r.time[0]) for r in rows]
        lasts = max(LASTS, sum(spans) / BLOCKS)
        block, record, first = [], [], 0
        for k, (r, span) in enumerate(zip(rows, spans, strict=True)):
            count = max(1, round(span / lasts))
            block.append(first + np.arange(len(r.time)) * count // len(r.time))
            record += [k] * count
            first += count
        of = np.array(record)
        return cls(tuple(rows), np.concatenate(block), of, of >= len(rows) - confirm)

    def stacked(self, name: str) -> np.ndarray:
        """Returns an array of all records, by the name of a field of `Rows`."""
        return np.concatenate([getattr(r, name) for r in self.rows])

    def divided(self, x: np.ndarray) -> list[np.ndarray]:
        """Returns the part of each record of an array (N, ...) of all records."""
        return np.split(x, np.cumsum([len(r.time) for r in self.rows])[:-1])

    def shifted(self, shifts: Sequence[float]) -> Equations:
        """Returns the equations with the inputs of each record by a time later [s]."""
        pairs = zip(self.rows, shifts, strict=True)
        return replace(self, rows=tuple(r.shifted(float(s)) for r, s in pairs))

    @property
    def noise(self) -> np.ndarray:
        """What noise alone would leave of each joint, shape (nv,), where it is white."""
        return np.sqrt(np.mean([r.noise**2 for r in self.rows], axis=0))

    @property
    def judges(self) -> np.ndarray:
        """Which blocks judge: those that confirm, or all where none does, shape (B,)."""
        return self.confirms if self.confirms.any() else ~self.confirms

    @property
    def joints(self) -> int:
        """Number of joints."""
        return self.rows[0].y.shape[1]

    def moments(self, x: np.ndarray) -> np.ndarray:
        """Returns Σ xᵀ x of x (N, nv, k) by joint and block, shape (nv, B, k, k)."""
        used, B = self.stacked("used"), len(self.record)
        edges = np.searchsorted(self.block, np.arange(B + 1))
        out = np.zeros((self.joints, B, x.shape[2], x.shape[2]))
        for j in range(self.joints):
            a = np.where(used[:, j, None], x[:, j], 0.0)
            if not a.any():
                continue
            for b in range(B):
                some = slice(edges[b], edges[b + 1])
                out[j, b] = a[some].T @ x[some, j]
        return out

    @property
    def counts(self) -> np.ndarray:
        """Number of equations by joint and block, shape (nv, B)."""
        return self.moments(np.ones((*self.stacked("y").shape, 1)))[:, :, 0, 0]


def model_forces(model: mujoco.MjModel, equations: Equations) -> np.ndarray:
    """Returns the forces that the model's masses alone need for the motion, shape (N, nv)."""
    X = all_columns(equations.stacked("bodies"), equations.stacked("a"))
    return np.asarray(X @ known_numbers(model))


def list_passive(model: mujoco.MjModel, equations: Equations) -> np.ndarray:
    """Returns which joints have no drive, or none that gives more than noise, shape (nv,).

    As much noise as a band leaves in accelerations hides a force of this share of the inertia's.
    """
    used = equations.stacked("used")
    force = np.where(used, equations.stacked("drives").sum(axis=2), 0.0)
    needed = np.where(used, model_forces(model, equations), 0.0)
    given, felt = ((x**2).sum(axis=0) for x in (force, needed))
    return np.asarray(used.any(axis=0) & (given <= ATTENUATION * felt))


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """Sizes fitted to equations."""

    θ: np.ndarray  # shape (p,), in their units
    covariance: np.ndarray  # shape (p, p)
    σ: np.ndarray  # residual of each joint, shape (nv,) [N m or N]; NaN without an equation
    κ: float  # of the weights
    weights: np.ndarray  # w, shape (nv,)
    H: np.ndarray  # shape (p, p)

    @property
    def std(self) -> np.ndarray:
        """Std of the sizes, shape (p,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))


def solve(G: np.ndarray, P: np.ndarray, θ_0: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns θ̂ and H of moments G (..., p + 1, p + 1), with priors of precision P and mean θ_0."""
    A, a = G[..., :-1, :-1], G[..., :-1, -1]
    H = A + np.diag(P)
    scale = 1 / np.sqrt(np.maximum(np.diagonal(H, axis1=-2, axis2=-1), 1e-300))
    unit = H * scale[..., :, None] * scale[..., None, :] + ROUNDING * np.eye(len(P))
    x = np.linalg.solve(unit, ((a + P * θ_0) * scale)[..., None])[..., 0]
    return scale * x, H


def unit_inverse(H: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns H⁻¹ in units in which H has a diagonal of ones, and these units s: H⁻¹ s sᵀ."""
    scale = 1 / np.sqrt(np.maximum(np.diag(H), 1e-300))
    return np.linalg.pinv(H * np.outer(scale, scale), rcond=1e-14, hermitian=True), scale


def left_over(G: np.ndarray, θ: np.ndarray) -> np.ndarray:
    """Returns ‖y - X θ‖² of moments G (..., p + 1, p + 1)."""
    t = np.concatenate([-θ, np.ones((*θ.shape[:-1], 1))], axis=-1)
    return np.maximum(np.einsum("...i,...ij,...j->...", t, G, t), 0.0)


def unseen_squares(
    M: np.ndarray, weights: np.ndarray, P: np.ndarray, θ_0: np.ndarray, confirms: np.ndarray
) -> np.ndarray:
    """Returns ‖y - X θ‖² by joint and block, with fits that did not see the block, shape (nv, B).

    The blocks of fitted records are cut into folds of neighbours, each predicted by a fit to all
    other folds; those that confirm are predicted by a fit to all of these. M (nv, B, p + 1, p + 1)
    are moments of columns and right side, `weights` (nv,) are of the joints, and P (p,) and θ_0
    (p,) are precision and means of the priors.
    """
    G, seen = np.einsum("j,jbpq->bpq", weights, M), ~confirms
    fold, n = np.zeros(len(G), int), int(seen.sum())
    fold[seen] = 1 + np.arange(n) * min(FOLDS, n) // n
    each = np.array([G[seen & (fold == k)].sum(axis=0) for k in range(fold.max() + 1)])
    θ, _ = solve(each.sum(axis=0) - each, P, θ_0)
    left = left_over(M, np.broadcast_to(θ[fold], (*M.shape[:2], len(P))))
    return np.maximum(left, NO_NOISE**2 * M[:, :, -1, -1])


def estimate(M: np.ndarray, counts: np.ndarray, P: np.ndarray, θ_0: np.ndarray) -> Estimate:
    """Fit sizes to equations, each joint weighted by its residual; see `unseen_squares`."""
    n, own, κ = counts.sum(axis=1), M.sum(axis=1), 1.0
    floor = NO_NOISE**2 * np.maximum(own[:, -1, -1], 1e-300)
    has = n > 0
    left = own[:, -1, -1]
    for _ in range(ROUNDS):
        w = np.where(has, n / np.maximum(left, floor), 0.0) / κ
        G = np.einsum("j,jbpq->bpq", w, M)
        θ, H = solve(G.sum(axis=0), P, θ_0)
        left = left_over(own, θ)
        meat, inverse, κ_now = _scatter(G, θ, H)
        κ = max(1.0, κ * κ_now)
    bread = inverse @ (meat + np.diag(P)) @ inverse
    σ = np.sqrt(np.where(has, left / np.maximum(n, 1), np.nan))
    return Estimate(θ=θ, covariance=bread, σ=σ, κ=κ, weights=w, H=H)


def _scatter(G: np.ndarray, θ: np.ndarray, H: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Returns Σ g gᵀ, H⁻¹ and the factor by which κ must grow."""
    A, a = G[:, :-1, :-1], G[:, :-1, -1]
    unit, scale = unit_inverse(H)
    inverse = unit * np.outer(scale, scale)
    g = a - A @ θ
    eye = np.eye(len(θ))
    # in units in which all sizes count alike, or what keeps it regular is lost in rounding
    lever = eye - (A * np.outer(scale, scale)) @ unit
    g = np.linalg.solve(lever + 1e-9 * eye, (g * scale)[:, :, None])[:, :, 0] / scale
    meat = g.T @ g
    felt = float(np.trace(A.sum(axis=0) @ inverse))
    return meat, inverse, float(np.einsum("bp,pq,bq->", g, inverse, g)) / max(felt, 1e-12)
