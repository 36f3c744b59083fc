"""Windows linearised at a point, and the damped step from there.

    r_w(q + Δq, d_w + Δd_w) = r_w - S_w Δq - X_w Δd_w,    X_w = U s Vᵀ, its columns scaled to norm 1

A direction of the initial states that a window hardly feels has s = 0: it is not moved.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

MIN_FELT_SHARE = 1e-6  # of the strongest direction of a state; weaker ones are not felt


@dataclass(frozen=True, kw_only=True)
class Tangent:
    """All windows, linearised at a point; X = U s Vᵀ, its columns scaled to the norm 1.

    Attributes:
        r: residual at the point, shape (W, m), m = L ny + nx.
        S: -∂r/∂q, shape (W, m, p).
        U: shape (W, m, nx).
        s: singular values, 0 for directions that are not felt, shape (W, nx).
        Vt: shape (W, nx, nx).
        size: norms of the columns of X before the scaling, shape (W, nx).
    """

    r: np.ndarray
    S: np.ndarray
    U: np.ndarray
    s: np.ndarray
    Vt: np.ndarray
    size: np.ndarray

    def rows(self, keep: np.ndarray) -> Tangent:
        """Returns some of the windows, by mask or by index."""
        return Tangent(**{f.name: getattr(self, f.name)[keep] for f in fields(self)})

    def with_rows(self, at: np.ndarray, other: Tangent) -> Tangent:
        """Returns the tangent with other values of the windows `at`, a mask or indices."""
        changed = {}
        for f in fields(self):
            changed[f.name] = np.array(getattr(self, f.name))
            changed[f.name][at] = getattr(other, f.name)
        return Tangent(**changed)

    @property
    def projected(self) -> np.ndarray:
        """S with the initial states projected out, shape (W m, p)."""
        U = self.U * (self.s > 0)[:, None]
        return (self.S - U @ (np.swapaxes(U, 1, 2) @ self.S)).reshape(-1, self.S.shape[2])

    @property
    def freedom(self) -> int:
        """Number of directions of the initial states that are felt, over all windows."""
        return int((self.s > 0).sum())

    def step(self, damping: float) -> tuple[np.ndarray, np.ndarray]:
        """Returns the damped step: Δq (p,) and Δd (W, nx)."""
        against = np.swapaxes(self.U, 1, 2) @ self.S  # Uᵀ S, (W, nx, p)
        left = np.einsum("wmk,wm->wk", self.U, self.r)
        share = self.s**2 / (self.s**2 + damping)
        H = np.einsum("wmp,wmq->pq", self.S, self.S)
        g = np.einsum("wmp,wm->p", self.S, self.r)
        H_q = H - np.einsum("wkp,wk,wkq->pq", against, share, against)
        g_q = g - np.einsum("wkp,wk,wk->p", against, share, left)
        size = np.sqrt(np.diag(H))
        size = np.where(size > 0, size, 1.0)  # one that a search drove to nothing stays there
        scaled = H_q / np.outer(size, size) + damping * np.eye(len(g))
        dq = np.linalg.lstsq(scaled, g_q / size, rcond=None)[0] / size
        along = self.s / (self.s**2 + damping) * (left - against @ dq)
        return dq, np.einsum("wkx,wk->wx", self.Vt, along) / self.size


def decomposed(r: np.ndarray, X: np.ndarray, S: np.ndarray) -> Tangent:
    """Returns the tangent of a residual r (W, m) with slopes X (W, m, nx) and S (W, m, p)."""
    size = np.linalg.norm(X, axis=1)
    size = np.where(size > 0, size, 1.0)
    U, s, Vt = np.linalg.svd(X / size[:, None], full_matrices=False)
    s = np.where(s > MIN_FELT_SHARE * s[:, :1], s, 0.0)
    return Tangent(r=r, S=S, U=U, s=s, Vt=Vt, size=size)


def along_states(t: Tangent, moves: np.ndarray) -> np.ndarray:
    """Returns X Δd of each window, shape (W, m)."""
    along = t.s * np.einsum("wkx,wx->wk", t.Vt, moves * t.size)
    return np.einsum("wmk,wk->wm", t.U, along)
