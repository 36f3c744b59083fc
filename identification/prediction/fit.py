"""Least squares over the windows of all records, by Levenberg and Marquardt.

    (H + μ diag H) Δq = g,    H = Σ_w S_wᵀ(I - P_w) S_w + W²
                              g = Σ_w S_wᵀ(I - P_w) r_w + W²(q̄ - q)

P_w projects on what the states of a window make up for, W = diag(1/σ) are the priors. The std of q
is that of a sum over blocks of windows, whose residuals need not be white (White 1980):

    cov(q) = H⁻¹ (Σ_b g_b g_bᵀ B/(B - 1) + W²) H⁻¹,    g_b = Σ_{w in b} S_wᵀ(I - P_w) r_w
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.levenberg_marquardt import Cost, Damping, levenberg_marquardt
from identification.estimation.options import Progress
from identification.model.rollout import State
from identification.prediction.problem import Problem
from identification.windows.shooting import Tangent

# Of the squared norms of the columns of X and S.
DAMPING = Damping(first=1e-3, raised=5.0, lowered=10.0, least=1e-9, floor=1e-9)
MOST_DAMPING = 1e3  # beyond, a step is too short to gain anything
ROUGH = 1e-2  # relative fall of the criterion that ends a fit whose last digits do not matter
FELT = 1e-20  # sum of squares of a column, in units of the errors' scale
BLOCKS = 40  # of windows, over all records, for the std

_Step = tuple[np.ndarray, tuple[np.ndarray, ...]]  # Δq (p,), and Δd (W, nx) of each record


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
        """Estimates by name, in their units; a record's own ones are `name [record]`."""
        space = self.problem.prior.space
        return dict(zip(space.names, space.decode(self.q).tolist(), strict=True))

    @property
    def shared(self) -> dict[str, float]:
        """Estimates of the parameters that all records share, by name, in their units."""
        values = self.values
        return {n: values[n] for n in self.problem.unknowns.shared.names}

    def of_record(self, record: int) -> dict[str, float]:
        """Estimates that one record feels, by name in the plant, in their units."""
        unknowns = self.problem.unknowns
        at = self.q[unknowns.columns(record)]
        space = unknowns.local.space
        return dict(zip(space.names, space.decode(at).tolist(), strict=True))

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
        """Std of each value by blocks of windows, in its unit, shape (p,); inf where none feels it.

        A parameter is felt where its column of S is beyond rounding, or a prior tells it.
        """
        q, felt = self.q, self.problem.prior.weight > 0
        felt |= sum(np.sum(t.S**2, axis=(0, 1)) for t in self.tangents) > FELT
        std = np.sqrt(np.diag(self.covariance)) * self.problem.prior.space.slope(q)
        return np.where(felt, std, np.inf)

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of q, shape (p, p)."""
        scores = np.concatenate([np.einsum("wmp,wm->wp", *projected(t)) for t in self.tangents])
        blocks = min(BLOCKS, max(2, len(scores)))
        g = np.array([part.sum(axis=0) for part in np.array_split(scores, blocks)])
        W2 = np.diag(self.problem.prior.weight**2)
        H = sum(_normal(t)[0] for t in self.tangents) + W2
        inverse = np.linalg.pinv(H, rcond=1e-14, hermitian=True)
        return np.asarray(inverse @ (g.T @ g * blocks / (blocks - 1) + W2) @ inverse)


def projected(t: Tangent) -> tuple[np.ndarray, np.ndarray]:
    """S and r without what the states of each window make up for: (W, m, p) and (W, m)."""
    U = t.U * (t.s > 0)[:, None]
    S = t.S - U @ (np.swapaxes(U, 1, 2) @ t.S)
    return S, t.r - np.einsum("wmk,wk->wm", U, np.einsum("wmk,wm->wk", U, t.r))


@dataclass(frozen=True)
class _AtPoint:
    """The criterion linearised at parameters and states, for `levenberg_marquardt`."""

    problem: Problem
    q: np.ndarray
    moves: tuple[np.ndarray, ...]
    tangents: tuple[Tangent, ...]

    @property
    def cost(self) -> float:
        data = sum(float(np.sum(t.r**2)) for t in self.tangents)
        return data + float(np.sum(self.problem.against(self.q) ** 2))

    def step(self, μ: Cost) -> _Step:
        return _step(self.problem, self.q, self.tangents, float(μ))

    def after(self, step: _Step) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
        space = self.problem.prior.space
        q = np.clip(self.q + step[0], space.lower, space.upper)
        return q, tuple(d + more for d, more in zip(self.moves, step[1], strict=True))

    def cost_after(self, step: _Step) -> float:
        try:
            return self.problem.cost(*self.after(step))
        except InputError:  # it diverged, or has no start: the search must go elsewhere
            return np.inf

    def bend(self, step: _Step, after: Cost, μ: Cost) -> None:
        """The steps are never bent."""

    def moved(self, step: _Step, taken: np.ndarray) -> _AtPoint:
        return _linearised(self.problem, *self.after(step))


def solve(
    problem: Problem,
    q: np.ndarray,
    moves: Sequence[np.ndarray],
    tolerance: float = 1e-4,
    most: int = 25,
    progress: Progress | None = None,
) -> WindowFit:
    """Search the least V from a start.

    Args:
        problem: windows and priors.
        q: where to begin, shape (p,).
        moves: of the windows' states, one array (W, nx) a record.
        tolerance: relative fall of V at which the search ends.
        most: linearisations at most.
        progress: is told one line per linearisation.

    Raises:
        DivergenceError: the start cannot be simulated.
    """
    at = _linearised(problem, problem.prior.space.inside(q), tuple(moves))
    converged, steps = False, 1
    samples = sum(p.cut.outputs.size for p in problem.parts)
    trials = levenberg_marquardt(at, _AtPoint.moved, DAMPING)
    while not converged and steps < most:
        try:
            trial = next(trials)
        except DivergenceError:  # a neighbour of the new point: the last one stands
            break
        before = at.cost
        if trial.taken:
            at = trial.criterion
        elif trial.next > MOST_DAMPING:  # one window may bar the way of all: each for itself
            at = _linearised(problem, at.q, problem.settled(at.q, at.moves))
            trials = levenberg_marquardt(at, _AtPoint.moved, DAMPING)
        else:
            continue
        steps += 1
        converged = bool(before - at.cost < tolerance * before)
        if progress is not None:
            error = np.sqrt(at.cost / samples)
            progress(f"windows: error {error:.4g} of its scale, step {steps}")
    return WindowFit(
        problem=problem, q=at.q, moves=at.moves, tangents=at.tangents, cost=at.cost,
        converged=converged, steps=steps,
    )  # fmt: skip


def _linearised(problem: Problem, q: np.ndarray, moves: tuple[np.ndarray, ...]) -> _AtPoint:
    return _AtPoint(problem, q, moves, problem.tangents(q, moves))


def _normal(t: Tangent) -> tuple[np.ndarray, np.ndarray]:
    """H and g of the windows of a record, their states eliminated."""
    S, r = projected(t)
    return np.einsum("wmp,wmq->pq", S, S), np.einsum("wmp,wm->p", S, r)


def _step(problem: Problem, q: np.ndarray, tangents: Sequence[Tangent], damping: float) -> _Step:
    """The damped step of the parameters and of the windows' states."""
    H, g = np.diag(problem.prior.weight**2), problem.prior.weight * problem.against(q)
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
