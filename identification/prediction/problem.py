"""Windows of all records at once: their residuals, and the tangent of a step.

    V(q, d) = Σ_r Σ_w ‖(y_rw - ŷ_rw(q, x̄_rw ⊕ d_rw))/s‖² + ‖d_rw/s_x‖²  +  Σ_j ((q_j - q̄_j)/σ_j)²

r: record, w: window of it, d_rw: its state at the start, s: rms of each output's error under the
nominal model, q̄, σ: what was known of a parameter before the records spoke. The states of a window
are eliminated by themselves (`identification.windows.shooting`), so that records add up.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from identification.model.predictor import Plant, Predictor
from identification.prediction.records import Record
from identification.prediction.unknowns import Prior, Unknowns
from identification.windows.held import at_values
from identification.windows.settling import settle
from identification.windows.shooting import Shooting, Tangent, tangent
from identification.windows.windows import first_states, spread, windows

# Steps of a simulation of all windows. More windows only make estimates finer than what is missing
# from the model makes them wrong, and each of some hundred simulations takes as much longer.
MOST_STEPS = 24_000
FEWEST_WINDOWS = 10  # of a record, so that blocks of them can be compared
THIN = 3  # one window of so many screens candidates, and finds where a fit of all windows begins


@dataclass(frozen=True)
class Problem:
    """What does not change while parameters and states of windows are sought.

    Attributes:
        parts: the windows of each record that is fitted; each feels its own columns of q.
        unknowns: the free parameters, and what is known of them.
    """

    parts: tuple[Shooting, ...]
    unknowns: Unknowns

    @cached_property
    def prior(self) -> Prior:
        """Of all p free parameters."""
        return self.unknowns.all

    @property
    def names(self) -> tuple[str, ...]:
        """The free parameters."""
        return self.prior.names

    def against(self, q: np.ndarray) -> np.ndarray:
        """What the priors hold against q, in their std, shape (p,)."""
        return self.prior.weight * (self.prior.mean - q)

    def cost(self, q: np.ndarray, d: Sequence[np.ndarray]) -> float:
        """V at q and at the moves of the windows' states, one array (W, nx) a record.

        Raises:
            DivergenceError: a window left the finite numbers.
        """
        data = sum(
            float(np.sum(part.residual(own, moves) ** 2)) for part, own, moves in self._each(q, d)
        )
        return data + float(np.sum(self.against(q) ** 2))

    def best(
        self, q: np.ndarray, choices: Sequence[Sequence[np.ndarray]]
    ) -> tuple[tuple[np.ndarray, ...], float]:
        """Of several moves of the states the best, each window for itself, and V there.

        Args:
            q: shape (p,).
            choices: moves of the windows' states, each of them one array (W, nx) a record.

        Raises:
            DivergenceError: a window left the finite numbers.
        """
        moves, cost = [], float(np.sum(self.against(q) ** 2))
        for k, part in enumerate(self.parts):
            own, each = q[self.unknowns.columns(k)], [c[k] for c in choices]
            y = part.outputs(np.tile(own, (len(each), 1)), each)
            squares = np.array([np.sum(part.joined(*pair) ** 2, axis=1)
                                for pair in zip(y, each, strict=True)])  # fmt: skip
            cost += float(squares.min(axis=0).sum())
            moves.append(np.stack(each)[squares.argmin(axis=0), np.arange(len(squares[0]))])
        return tuple(moves), cost

    def tangents(self, q: np.ndarray, d: Sequence[np.ndarray]) -> tuple[Tangent, ...]:
        """All windows linearised, one tangent a record, its S with a column for each of q."""
        return tuple(
            self.widened(k, tangent(part, own, moves))
            for k, (part, own, moves) in enumerate(self._each(q, d))
        )

    def widened(self, record: int, t: Tangent) -> Tangent:
        """A tangent of the record's own columns with columns of zeros for all others."""
        if not self.unknowns.own.names:
            return t
        S = np.zeros((*t.S.shape[:2], len(self.names)))
        S[..., self.unknowns.columns(record)] = t.S
        return replace(t, S=S)

    def settled(
        self,
        q: np.ndarray,
        d: Sequence[np.ndarray],
        near: Sequence[Tangent] | None = None,
        is_thorough: bool = False,
    ) -> tuple[np.ndarray, ...]:
        """The moves of the states that are best at q, each window for itself, from d on.

        Args:
            q: shape (p,).
            d: moves of the windows' states, one array (W, nx) a record.
            near: the windows linearised nearby, one a record; it saves simulations.
            is_thorough: whether windows that end far worse than others are sought again.

        Raises:
            DivergenceError: a window left the finite numbers at q and d.
        """
        held = [at_values(part, own) for part, own, _ in self._each(q, d)]
        return tuple(s.d for s in settle(held, d, near, is_thorough))

    def _each(
        self, q: np.ndarray, d: Sequence[np.ndarray]
    ) -> Iterator[tuple[Shooting, np.ndarray, np.ndarray]]:
        for k, (part, moves) in enumerate(zip(self.parts, d, strict=True)):
            yield part, q[self.unknowns.columns(k)], moves


def problem(
    plant: Plant,
    records: Sequence[Record],
    shared: Prior,
    own: Prior,
    length: float,
    values: Mapping[str, float],
    scale: np.ndarray,
    most_steps: int = MOST_STEPS,
) -> Problem:
    """Cut records into windows, each of which begins where the robot was measured.

    Args:
        plant: the model.
        records: to be fitted.
        shared: the free parameters that all records share.
        own: the free parameters that each record has for itself.
        length: of a window [s].
        values: of all parameters that are not the plant's own; they say where unmeasured states
            begin.
        scale: s of each output, shape (ny,), in its unit.
        most_steps: see `most_windows`.

    Raises:
        InputError: windows do not fit a record.
    """
    parts = []
    space = shared.plus(own).space
    begun = {**plant.parameters.values(), **values}
    most = most_windows(plant, records, length, most_steps)
    for record in records:
        fixed = {n: v for n, v in {**values, **record.values}.items() if n not in space.names}
        predictor = Predictor(plant, record.log, space.names, fixed)
        cut = spread(windows(record.log, length), most)
        first = first_states(predictor, np.array([begun[n] for n in space.names]), cut)
        parts.append(Shooting(predictor, space, cut, first, np.diag(1 / scale), True))
    return Problem(tuple(parts), Unknowns(shared, own, tuple(r.log.name for r in records)))


def most_windows(
    plant: Plant, records: Sequence[Record], length: float, most_steps: int = MOST_STEPS
) -> int:
    """How many windows of each record are simulated at most, so that all take `most_steps`."""
    each = max(length / plant.model.opt.timestep, 1.0)
    return max(FEWEST_WINDOWS, int(most_steps / (each * max(1, len(records)))))


def no_moves(problem_: Problem) -> tuple[np.ndarray, ...]:
    """States that begin where they are believed to begin, one array (W, nx) a record."""
    out = []
    for part in problem_.parts:
        model = part.predictor.plant.model
        out.append(np.zeros((len(part.cut.starts), 2 * model.nv + model.na)))
    return tuple(out)


def with_unknowns(
    problem_: Problem, shared: Prior, own: Prior, fixed: Mapping[str, float]
) -> Problem:
    """The same windows with other free parameters, and other values of those that are not free."""
    parts, space = [], shared.plus(own).space
    for part in problem_.parts:
        values = {**part.predictor.fixed, **fixed}
        rest = {n: v for n, v in values.items() if n not in space.names}
        predictor = replace(part.predictor, names=space.names, fixed=rest)
        parts.append(replace(part, space=space, predictor=predictor))
    return Problem(tuple(parts), Unknowns(shared, own, problem_.unknowns.records))


def thinned(problem_: Problem, every: int) -> Problem:
    """Some of the windows: one of `every`, but no fewer than `FEWEST_WINDOWS` a record."""
    parts = tuple(p.rows(kept(len(p.cut.starts), every)) for p in problem_.parts)
    return replace(problem_, parts=parts)


def thinned_moves(moves: Sequence[np.ndarray], every: int) -> tuple[np.ndarray, ...]:
    """The moves of the states of the windows that `thinned` keeps."""
    return tuple(d[kept(len(d), every)] for d in moves)


def thinned_tangents(tangents: Sequence[Tangent], every: int) -> tuple[Tangent, ...]:
    """The tangents of the windows that `thinned` keeps."""
    return tuple(t.rows(kept(len(t.r), every)) for t in tangents)


def kept(count: int, every: int) -> np.ndarray:
    """Indices of the windows of a record that `thinned` keeps."""
    return np.arange(0, count, max(1, min(every, count // FEWEST_WINDOWS)))


def with_scale(problem_: Problem, scale: np.ndarray) -> Problem:
    """The same windows whose errors count in units of another scale s, shape (ny,)."""
    whitener = np.diag(1 / scale)
    return replace(problem_, parts=tuple(replace(p, whitener=whitener) for p in problem_.parts))
