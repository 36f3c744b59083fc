"""Least squares over the windows of all records, by Levenberg and Marquardt.

The std of the estimate is that of a sum over blocks of windows, whose residuals need not be white
(White 1980):

    cov(q) = H⁻¹ (Σ_b g_b g_bᵀ B/(B - 1) + W²) H⁻¹,    g_b = Σ_{w in b} S_wᵀ(I - P_w) r_w

H, P_w and W are those of `identification.windows.point`.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import count

import numpy as np

from identification.errors import InputError
from identification.estimation.levenberg_marquardt import Damping, levenberg_marquardt
from identification.estimation.metrics import rms_by_unit
from identification.model.rollout import State
from identification.quantities import alike
from identification.runtime.progress import Progress, counted
from identification.windows.point import AtPoint, linearised
from identification.windows.problem import Problem, with_scale
from identification.windows.shooting import Tangent

# Of the squared norms of the columns of X and S.
DAMPING = Damping(first=1e-3, raised=5.0, least=1e-9)
# Sum of squares of a column, in units of the errors' scale, below which no window feels it.
COLUMN_ROUNDING = 1e-20
STD_BLOCKS = 40  # of windows, over all records: their scatter gives the std


@dataclass(frozen=True, kw_only=True, eq=False)
class WindowFit:
    """The result of a search over the windows of all records."""

    problem: Problem  # what was solved
    q: np.ndarray  # the estimate, shape (p,)
    moves: tuple[np.ndarray, ...]  # of the windows' states, one array (W, nx) a record
    tangents: tuple[Tangent, ...]  # the windows linearised there, one a record
    cost: float  # V there
    converged: bool  # whether the search ended by itself
    steps: int  # linearisations it took

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
        """Returns the estimates that one record feels, by name in the plant, in their units."""
        unknowns = self.problem.unknowns
        at = self.q[unknowns.columns(record)]
        space = unknowns.local.space
        return dict(zip(space.names, space.decode(at).tolist(), strict=True))

    @property
    def states(self) -> tuple[State, ...]:
        """The states in which the windows begin, W rows a record."""
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
        felt |= sum(np.sum(t.S**2, axis=(0, 1)) for t in self.tangents) > COLUMN_ROUNDING
        std = np.sqrt(np.diag(self.covariance)) * self.problem.prior.space.slope(q)
        return np.where(felt, std, np.inf)

    @property
    def information(self) -> np.ndarray:
        """Σ_w S_wᵀ(I - P_w) S_w: H without the priors, shape (p, p)."""
        each = (t.projected[0] for t in self.tangents)
        return np.asarray(sum(np.einsum("wmp,wmq->pq", S, S) for S in each))

    def weighed(self, scale: np.ndarray) -> WindowFit:
        """Returns the same values and slopes, with outputs that count in other units.

        Args:
            scale: of each output, shape (ny,), in its unit.
        """
        old = 1 / np.diag(self.problem.parts[0].whitener)
        if np.allclose(old, scale):
            return self
        tangents = []
        for part, t in zip(self.problem.parts, self.tangents, strict=True):
            _, L, ny = part.cut.outputs.shape
            states = np.ones(t.r.shape[1] - L * ny)
            tangents.append(t.weighed(np.concatenate([np.tile(old / scale, L), states])))
        return replace(
            self, problem=with_scale(self.problem, scale), tangents=tuple(tangents),
            cost=self.problem.cost_of(self.q, [t.r for t in tangents]),
        )  # fmt: skip

    @property
    def curvature(self) -> np.ndarray:
        """H, shape (p, p), in one over the squares of the coordinates."""
        return np.diag(self.problem.prior.weight**2) + self.information

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of q, shape (p, p)."""
        scores = np.concatenate([np.einsum("wmp,wm->wp", *t.projected) for t in self.tangents])
        blocks = min(STD_BLOCKS, max(2, len(scores)))
        g = np.array([part.sum(axis=0) for part in np.array_split(scores, blocks)])
        W2 = np.diag(self.problem.prior.weight**2)
        inverse = np.linalg.pinv(self.curvature, rcond=1e-14, hermitian=True)
        return np.asarray(inverse @ (g.T @ g * blocks / (blocks - 1) + W2) @ inverse)


def solve(
    problem: Problem,
    q: np.ndarray,
    moves: Sequence[np.ndarray],
    tolerance: float = 1e-4,
    most: int = 25,
    progress: Progress | None = None,
    known: Sequence[np.ndarray] | None = None,
) -> WindowFit:
    """Search the least V from a start.

    Args:
        problem: windows and priors.
        q: where to begin, shape (p,).
        moves: of the windows' states, one array (W, nx) a record.
        tolerance: relative fall of V at which the search ends, had or promised.
        most: linearisations at most.
        progress: is told one line per linearisation.
        known: residuals at the start, one array (W, m) a record; they are computed when None.

    Raises:
        DivergenceError: the start cannot be simulated.
    """
    begun = problem.prior.space.inside(q)
    there = known if np.array_equal(begun, q) else None  # on a bound: it begins beside the start
    at = linearised(problem, begun, tuple(moves), tolerance, there)
    converged, steps = False, 1
    trials = levenberg_marquardt(at, DAMPING)
    for _ in counted(count(), "steps of a fit"):
        if converged or steps >= most:
            break
        before = at.cost
        try:
            trial = next(trials)
            if trial.taken:
                at = trial.criterion
                steps += at.is_fresh
                converged = bool(before - at.cost < tolerance * before)
            else:
                converged = not before - trial.step.promised > tolerance * before
            if not at.is_fresh and (converged or not trial.taken):  # old slopes prove nothing
                converged = False
                at, steps = at.refreshed(), steps + 1
                trials = levenberg_marquardt(at, DAMPING, trial.μ)
        except InputError:  # a neighbour of the new point cannot be simulated: the last one stands
            break
        if trial.taken and progress is not None:
            progress(f"error {_error_words(problem, at)}, step {steps}")
    if not at.is_fresh:  # std and scores are those of slopes here
        with suppress(InputError):
            at, steps = at.refreshed(), steps + 1
    return WindowFit(
        problem=problem, q=at.q, moves=at.moves, tangents=at.tangents, cost=at.cost,
        converged=converged, steps=steps,
    )  # fmt: skip


def _error_words(problem: Problem, at: AtPoint) -> str:
    """Returns the rms error of the windows at a point with its unit, one for each unit."""
    log = problem.parts[0].predictor.log
    pairs = zip(problem.parts, at.tangents, strict=True)
    each = np.concatenate([part.error(t.r).reshape(-1, len(log.output_names)) for part, t in pairs])
    told = [f"{alike([rms], unit, 4)[0]} rms" for unit, rms in rms_by_unit(each, log).items()]
    return " and ".join(told)
