"""Least squares over the windows of all records, by Levenberg and Marquardt.

    (H + μ diag H) Δq = g,    H = Σ_w S_wᵀ(I - P_w) S_w + W²
                              g = Σ_w S_wᵀ(I - P_w) r_w + W²(q̄ - q)

P_w projects on what the states of a window make up for, W = diag(1/σ) are the priors. The std of q
is that of a sum over blocks of windows, whose residuals need not be white (White 1980):

    cov(q) = H⁻¹ (Σ_b g_b g_bᵀ B/(B - 1) + W²) H⁻¹,    g_b = Σ_{w in b} S_wᵀ(I - P_w) r_w
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.shooting import Tangent
from identification.model.rollout import State
from identification.prediction.problem import Problem

FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-9, 1e6
BLOCKS = 40  # of windows, over all records, for the std


@dataclass(frozen=True, kw_only=True)
class WindowFit:
    """Where a search over the windows of all records ended.

    Attributes:
        problem: what was solved.
        q: the estimate, shape (p,).
        moves: of the windows' states, one array (W, nx) a record.
        tangents: the windows linearised there, one a record.
        cost: V there.
        converged: whether the search ended by itself.
        steps: linearisations it took.
    """

    problem: Problem
    q: np.ndarray
    moves: tuple[np.ndarray, ...]
    tangents: tuple[Tangent, ...]
    cost: float
    converged: bool
    steps: int

    @property
    def values(self) -> dict[str, float]:
        """Estimates by name, in their units."""
        space = self.problem.space
        return dict(zip(space.names, space.decode(self.q).tolist(), strict=True))

    @property
    def states(self) -> tuple[State, ...]:
        """Where each window begins, W rows a record."""
        return tuple(p.states(d) for p, d in zip(self.problem.parts, self.moves, strict=True))

    @property
    def errors(self) -> tuple[np.ndarray, ...]:
        """y - ŷ of the windows, shape (W, L, ny) a record, in the outputs' units."""
        each = zip(self.problem.parts, self.tangents, strict=True)
        return tuple(part.error(t.r) for part, t in each)

    @property
    def std(self) -> np.ndarray:
        """Std of each value by blocks of windows, in its unit, shape (p,)."""
        q = self.q
        return np.sqrt(np.diag(self.covariance)) * self.problem.space.slope(q)

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of q, shape (p, p)."""
        scores = np.concatenate([np.einsum("wmp,wm->wp", *projected(t)) for t in self.tangents])
        blocks = min(BLOCKS, max(2, len(scores)))
        g = np.array([part.sum(axis=0) for part in np.array_split(scores, blocks)])
        W2 = np.diag(self.problem.weight**2)
        H = sum(_normal(t)[0] for t in self.tangents) + W2
        inverse = np.linalg.pinv(H, rcond=1e-14, hermitian=True)
        return np.asarray(inverse @ (g.T @ g * blocks / (blocks - 1) + W2) @ inverse)


def projected(t: Tangent) -> tuple[np.ndarray, np.ndarray]:
    """S and r without what the states of each window make up for: (W, m, p) and (W, m)."""
    U = t.U * (t.s > 0)[:, None]
    S = t.S - U @ (np.swapaxes(U, 1, 2) @ t.S)
    return S, t.r - np.einsum("wmk,wk->wm", U, np.einsum("wmk,wm->wk", U, t.r))


def solve(
    problem: Problem,
    q: np.ndarray,
    moves: Sequence[np.ndarray],
    tolerance: float = 1e-4,
    most: int = 25,
    progress: Callable[[str], None] | None = None,
) -> WindowFit:
    """Search the least V from a start.

    Args:
        problem: windows and priors.
        q: where to begin, shape (p,).
        moves: of the windows' states, one array (W, nx) a record.
        tolerance: relative fall of V, and change of q, at which the search ends.
        most: linearisations at most.
        progress: is told one line per linearisation.

    Raises:
        DivergenceError: the start cannot be simulated.
    """
    low, high = problem.space.lower, problem.space.upper
    q, moves = np.clip(q, low, high), tuple(moves)
    tangents = problem.tangents(q, moves)
    cost, damping = _cost(problem, q, tangents), FIRST_DAMPING
    for step in range(1, most + 1):
        if progress is not None:
            samples = sum(p.cut.outputs.size for p in problem.parts)
            progress(f"windows: error {np.sqrt(cost / samples):.4g} of its scale, step {step}")
        while True:
            dq, dd = _step(problem, q, tangents, damping)
            trial = np.clip(q + dq, low, high)
            there = tuple(d + more for d, more in zip(moves, dd, strict=True))
            try:
                after = problem.cost(trial, there)
            except InputError:  # it diverged, or has no start: the search must go elsewhere
                after = np.inf
            if after < cost:
                break
            if damping > MOST_DAMPING or np.abs(dq).max(initial=0.0) < tolerance * 1e-2:
                return WindowFit(
                    problem=problem, q=q, moves=moves, tangents=tangents, cost=cost,
                    converged=damping <= MOST_DAMPING, steps=step,
                )  # fmt: skip
            damping *= 5
        small = cost - after < tolerance * cost
        q, moves, damping = trial, there, max(damping / 10, LEAST_DAMPING)
        try:
            tangents = problem.tangents(q, moves)
        except DivergenceError:  # a moved neighbour is lost: the point itself is good
            small = True
        cost = after
        if small:
            return WindowFit(
                problem=problem, q=q, moves=moves, tangents=tangents, cost=cost, converged=True,
                steps=step,
            )  # fmt: skip
    return WindowFit(
        problem=problem, q=q, moves=moves, tangents=tangents, cost=cost, converged=False, steps=most
    )


def _cost(problem: Problem, q: np.ndarray, tangents: Sequence[Tangent]) -> float:
    data = sum(float(np.sum(t.r**2)) for t in tangents)
    return data + float(np.sum(problem.against(q) ** 2))


def _normal(t: Tangent) -> tuple[np.ndarray, np.ndarray]:
    """H and g of the windows of a record, their states eliminated."""
    S, r = projected(t)
    return np.einsum("wmp,wmq->pq", S, S), np.einsum("wmp,wm->p", S, r)


def _step(
    problem: Problem, q: np.ndarray, tangents: Sequence[Tangent], damping: float
) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """The damped step of the parameters and of the windows' states."""
    H, g = np.diag(problem.weight**2), problem.weight * problem.against(q)
    for t in tangents:
        against, left, share = _states(t, damping)
        H = H + np.einsum("wmp,wmq->pq", t.S, t.S)
        H = H - np.einsum("wkp,wk,wkq->pq", against, share, against)
        g = g + np.einsum("wmp,wm->p", t.S, t.r) - np.einsum("wkp,wk,wk->p", against, share, left)
    size = np.sqrt(np.maximum(np.diag(H), 0.0))
    size = np.where(size > 0, size, 1.0)
    scaled = H / np.outer(size, size) + damping * np.eye(len(g))
    dq = np.linalg.lstsq(scaled, g / size, rcond=1e-14)[0] / size
    moves = []
    for t in tangents:
        against, left, _ = _states(t, damping)
        along = t.s / (t.s**2 + damping) * (left - against @ dq)
        moves.append(np.einsum("wkx,wk->wx", t.Vt, along) / t.size)
    return dq, tuple(moves)


def _states(t: Tangent, damping: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    against = np.swapaxes(t.U, 1, 2) @ t.S  # Uᵀ S, (W, nx, p)
    left = np.einsum("wmk,wm->wk", t.U, t.r)
    return against, left, t.s**2 / (t.s**2 + damping)
