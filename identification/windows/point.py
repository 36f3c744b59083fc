"""The criterion of all windows, linearised at a point, and the steps of a search from there.

    (H + μ diag H) Δq = g,    H = Σ_w S_wᵀ(I - P_w) S_w + W²
                              g = Σ_w S_wᵀ(I - P_w) r_w + W²(q̄ - q)

A linearisation takes a simulation of all windows for each parameter. Where they are many, slopes
are kept as long as steps gain what they promise (chord method; Ortega, Rheinboldt 1970, 7.1).

P_w projects on what the states of a window make up for, W = diag(1/σ) are the priors. A step moves
parameters and states together. Where a joint sticks or a limit is met the criterion is not smooth
in the states, and a few windows would bar the way of all: each window may keep the state that it
had, and where that is not enough, its state is sought anew at the new parameters (variable
projection; Golub, Pereyra 1973).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError
from identification.estimation.levenberg_marquardt import (
    KEPT_GAIN,
    SLOPE_ERROR,
    Cost,
    Criterion,
)
from identification.model.coordinates import Coordinates
from identification.windows.problem import Problem, best_of
from identification.windows.settling import settle
from identification.windows.shooting import Tangent, along_states

KEEP_SLOPES_FROM = 12  # parameters: with fewer, new slopes cost less than the steps they save
# Of the cost after a step to that before it: beyond it no states bring the step back.
REJECT_COST_RATIO = 4.0
Moves = tuple[np.ndarray, ...]  # of the windows' states, one array (W, nx) a record


@dataclass(frozen=True)
class Step:
    """The end of a trial step."""

    q: np.ndarray  # the parameters there, shape (p,)
    moves: Moves  # of the windows' states there, one array (W, nx) a record
    residuals: tuple[np.ndarray, ...]  # there, one array (W, m) a record
    cost: float  # V there; infinite where it cannot be simulated
    promised: float  # V there by the linearisation


@dataclass(frozen=True)
class AtPoint(Criterion[Step]):
    """The criterion linearised at parameters and states, for `levenberg_marquardt`."""

    problem: Problem  # windows and priors
    q: np.ndarray  # shape (p,)
    moves: Moves  # of the windows' states, one array (W, nx) a record
    # the windows linearised, one a record: r there, and slopes there or before
    tangents: tuple[Tangent, ...]
    tolerance: float  # relative fall of V that is worth a search of the states
    is_fresh: bool = True  # whether slopes are those at this point

    @property
    def cost(self) -> float:
        """V."""
        data = sum(float(np.sum(t.r**2)) for t in self.tangents)
        return data + float(np.sum(self.problem.prior.against(self.q) ** 2))

    def step(self, μ: Cost) -> Step:
        """Returns the end of the step with damping μ."""
        dq, dd = step_of(self.problem, self.q, self.tangents, float(μ))
        q = self.q + dq
        expected = self._expected(dq, dd)
        promised = sum(float(e.sum()) for e in expected)
        promised += float(np.sum(self.problem.prior.against(q) ** 2))
        moves = tuple(d + more for d, more in zip(self.moves, dd, strict=True))
        try:
            held = self.problem.held(q)
            moves, r = best_of(held, moves, self.moves, self._enough(expected))
            cost = self.problem.cost_of(q, r)
            hoped = self.cost - promised
            is_short = hoped > self.tolerance * self.cost and self.cost - cost < KEPT_GAIN * hoped
            if is_short and cost < REJECT_COST_RATIO * self.cost:
                most = self.cost - float(np.sum(self.problem.prior.against(q) ** 2))
                settled = settle(held, moves, self.tangents, known=r, expected=expected, most=most)
                moves, r = tuple(s.d for s in settled), tuple(s.r for s in settled)
                cost = self.problem.cost_of(q, r)
        except InputError:  # it diverged, or has no start: the search must go elsewhere
            return Step(q, moves, (), np.inf, promised)
        return Step(q, moves, r, cost, promised)

    def apart(self, step: Step, μ: Cost, raised: float) -> float:
        """Returns the damping, μ or larger, whose step of the parameters is not the rejected one.

        Far below the curvature, damping does nothing: the same step would be simulated, and its
        states sought, up to ten times before it becomes a shorter one. Steps are as good as the
        slopes, which tell none from another that is so near.
        """
        damping, tried = float(μ), step.q - self.q
        while True:
            dq, size, _ = parameters_step(self.problem, self.q, self.tangents, damping)
            change, far = np.linalg.norm((dq - tried) * size), np.linalg.norm(tried * size)
            if not change < SLOPE_ERROR * far:
                return damping
            damping *= raised

    def cost_after(self, step: Step) -> float:
        """Returns V after a step."""
        return step.cost

    def moved(self, step: Step, taken: np.ndarray) -> AtPoint:
        """Returns the criterion after a step, with the slopes before it where they serve."""
        gain, promised = self.cost - step.cost, self.cost - step.promised
        if len(self.q) < KEEP_SLOPES_FROM or gain < KEPT_GAIN * promised:
            return linearised(self.problem, step.q, step.moves, self.tolerance, step.residuals)
        each = zip(self.tangents, step.residuals, strict=True)
        return replace(
            self, q=step.q, moves=step.moves, tangents=tuple(replace(t, r=r) for t, r in each),
            is_fresh=False,
        )  # fmt: skip

    def refreshed(self) -> AtPoint:
        """Returns the criterion with slopes at this point.

        Raises:
            DivergenceError: it cannot be simulated beside it.
        """
        known = [t.r for t in self.tangents]
        return linearised(self.problem, self.q, self.moves, self.tolerance, known)

    def _enough(self, expected: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Returns sums of squares at which windows have followed a step, one array (W,) a record.

        A window that keeps the state it had can gain little more than these leave.
        """
        before = [np.sum(t.r**2, axis=1) for t in self.tangents]
        least = self.tolerance * float(np.mean(np.concatenate(before)))
        pairs = zip(before, expected, strict=True)
        return [e + (1 - KEPT_GAIN) * np.abs(b - e) + least for b, e in pairs]

    def _expected(self, dq: np.ndarray, dd: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Returns the linearisation's sums of squares after a step, one array (W,) a record."""
        return [
            np.sum((t.r - t.S @ dq - along_states(t, d)) ** 2, axis=1)
            for t, d in zip(self.tangents, dd, strict=True)
        ]


def linearised(
    problem: Problem, q: np.ndarray, moves: Moves, tolerance: float,
    known: Sequence[np.ndarray] | None = None,
) -> AtPoint:  # fmt: skip
    """Returns the criterion linearised at q (p,) and moves of the states, with `known` residuals.

    Raises:
        DivergenceError: it cannot be simulated there, or beside it.
    """
    return AtPoint(problem, q, moves, problem.tangents(q, moves, known), tolerance)


def step_of(
    problem: Problem, q: np.ndarray, tangents: Sequence[Tangent], damping: float
) -> tuple[np.ndarray, Moves]:
    """Returns the damped step of the parameters, within bounds, and of the windows' states."""
    dq, _, each = parameters_step(problem, q, tangents, damping)
    moves = (
        t.states_step(dq, damping, against, rest)
        for t, (against, rest, _) in zip(tangents, each, strict=True)
    )
    return dq, tuple(moves)


def parameters_step(
    problem: Problem, q: np.ndarray, tangents: Sequence[Tangent], damping: float
) -> tuple[np.ndarray, np.ndarray, list[tuple[np.ndarray, np.ndarray, np.ndarray]]]:
    """Returns the damped step of the parameters, within bounds, (p,), and norms of columns, (p,).

    What `Tangent.eliminated` returns of each record stands behind them.
    """
    H, g = np.diag(problem.prior.weight**2), problem.prior.weight * problem.prior.against(q)
    each = [t.eliminated(damping) for t in tangents]
    for t, (against, rest, share) in zip(tangents, each, strict=True):
        H = H + np.einsum("wmp,wmq->pq", t.S, t.S)
        H = H - np.einsum("wkp,wk,wkq->pq", against, share, against)
        g = g + np.einsum("wmp,wm->p", t.S, t.r) - np.einsum("wkp,wk,wk->p", against, share, rest)
    size = np.sqrt(np.maximum(np.diag(H), 0.0))
    size = np.where(size > 0, size, 1.0)
    scaled = H / np.outer(size, size) + damping * np.eye(len(g))
    return _within(scaled, g / size, problem.prior.space, q, size), size, each


def _within(
    H: np.ndarray, g: np.ndarray, space: Coordinates, q: np.ndarray, size: np.ndarray
) -> np.ndarray:
    """Returns Δq = x/size of H x = g, with values that would leave their bounds held there."""
    x, free = np.zeros(len(g)), np.ones(len(g), bool)
    low, high = (space.lower - q) * size, (space.upper - q) * size
    while free.any():
        F = np.ix_(free, free)
        x[free] = np.linalg.lstsq(H[F], g[free] - H[free][:, ~free] @ x[~free], rcond=1e-14)[0]
        beyond = free & ((x < low) | (x > high))
        if not beyond.any():
            break
        x[beyond] = np.clip(x, low, high)[beyond]
        free &= ~beyond
    return np.asarray(x / size)
