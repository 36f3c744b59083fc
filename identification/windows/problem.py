"""Windows of all records at once: their residuals, and the tangent of a step.

    V(q, d) = Σ_r Σ_w ‖(y_rw - ŷ_rw(q, x̄_rw ⊕ d_rw))/s‖² + ‖d_rw/s_x‖²  +  Σ_j ((q_j - q̄_j)/σ_j)²

r: record, w: window of it, d_rw: its state at the start, s: rms of each output's error under the
nominal model, q̄, σ: what was known of a parameter before the records spoke. The states of a window
are eliminated by themselves (`identification.windows.shooting`), so that records add up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from identification.effects.plant.jointed import JointPlant
from identification.errors import DivergenceError
from identification.estimation.priors import Priors
from identification.logs.parts import inside
from identification.model.predictor import Plant, Predictor
from identification.windows.coarse import (
    own_step,
    with_longest_slope_steps,
    with_longest_steps,
)
from identification.windows.held import HeldRecords, at_values, held_records
from identification.windows.records import Record
from identification.windows.settling import settle
from identification.windows.shooting import Shooting, Tangent, tangents
from identification.windows.unknowns import Unknowns
from identification.windows.windows import Windows, first_states, spread, windows

# Steps of a simulation of all windows. More windows only make estimates finer than what is missing
# from the model makes them wrong, and each of some hundred simulations takes as much longer.
MOST_STEPS = 24_000
ROUGH_STEPS = MOST_STEPS // 3  # of fits that prove nothing, such as one that begins another
MIN_WINDOWS = 10  # of a record, so that blocks of them can be compared


@dataclass(frozen=True)
class Problem:
    """The data and unknowns that do not change while parameters and states are sought."""

    # the windows of each record that is fitted; each feels its own columns of q
    parts: tuple[Shooting, ...]
    unknowns: Unknowns  # the free parameters, and what is known of them

    @cached_property
    def prior(self) -> Priors:
        """The prior of all p free parameters."""
        return self.unknowns.all

    @property
    def plant(self) -> Plant:
        """The plant, the same for all records."""
        return self.parts[0].predictor.plant

    @property
    def names(self) -> tuple[str, ...]:
        """The free parameters."""
        return self.prior.names

    def held(self, q: np.ndarray) -> HeldRecords:
        """Returns the windows of all records with the parameters q (p,) held."""
        parts = enumerate(self.parts)
        return held_records([at_values(part, q[self.unknowns.columns(k)]) for k, part in parts])

    def cost_of(self, q: np.ndarray, residuals: Sequence[np.ndarray]) -> float:
        """Returns V at q, of the residuals there, one array (W, m) a record.

        Raises:
            DivergenceError: a window left the finite numbers.
        """
        data = sum(float(np.sum(r**2)) for r in residuals)
        if not np.isfinite(data):
            raise DivergenceError("the simulation of a window diverged; use a smaller step")
        return data + float(np.sum(self.prior.against(q) ** 2))

    def tangents(
        self, q: np.ndarray, d: Sequence[np.ndarray], known: Sequence[np.ndarray] | None = None
    ) -> tuple[Tangent, ...]:
        """Returns all windows linearised, one tangent a record, its S with a column for each of q.

        Args:
            q: shape (p,).
            d: moves of the windows' states, one array (W, nx) a record.
            known: residuals there, one array (W, m) a record; they are computed when None.
        """
        known = known or self.held(q).residuals(d)
        self.cost_of(q, known)
        each = [q[self.unknowns.columns(k)] for k in range(len(self.parts))]
        found = tangents(self.parts, each, d, known)
        return tuple(self.widened(k, t) for k, t in enumerate(found))

    def tangents_after(
        self, before: Sequence[Tangent], q: np.ndarray, d: Sequence[np.ndarray],
        known: Sequence[np.ndarray], is_moved: Sequence[np.ndarray],
    ) -> tuple[Tangent, ...]:  # fmt: skip
        """Returns the windows linearised at q, of which some have moved since.

        Args:
            before: their tangents at q, one a record.
            q: shape (p,).
            d: moves of their states, one array (W, nx) a record.
            known: residuals there, one array (W, m) a record.
            is_moved: which of them begin elsewhere than before, one mask (W,) a record.
        """
        out, some = [*before], [k for k, at in enumerate(is_moved) if at.any()]
        moved = tangents(
            [self.parts[k].rows(is_moved[k]) for k in some],
            [q[self.unknowns.columns(k)] for k in some],
            [d[k][is_moved[k]] for k in some], [known[k][is_moved[k]] for k in some],
        )  # fmt: skip
        for k, t in zip(some, moved, strict=True):
            out[k] = out[k].with_rows(is_moved[k], self.widened(k, t))
        return tuple(out)

    def widened(self, record: int, t: Tangent) -> Tangent:
        """Returns a tangent of the record's own columns with columns of zeros for all others."""
        if not self.unknowns.own.names:
            return t
        S = np.zeros((*t.S.shape[:2], len(self.names)))
        S[..., self.unknowns.columns(record)] = t.S
        return replace(t, S=S)

    def settled(
        self, q: np.ndarray, d: Sequence[np.ndarray], near: Sequence[Tangent] | None = None,
        is_thorough: bool = False,
    ) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:  # fmt: skip
        """Returns the moves of the states that are best at q, by window, and the residuals there.

        Args:
            q: shape (p,).
            d: moves where the search begins, one array (W, nx) a record.
            near: the windows linearised nearby, one a record; it saves simulations.
            is_thorough: whether windows that end far worse than others are sought again.

        Raises:
            DivergenceError: a window left the finite numbers at q and d.
        """
        each = settle(self.held(q), d, near, is_thorough)
        self.cost_of(q, [s.r for s in each])  # it is finite
        return tuple(s.d for s in each), tuple(s.r for s in each)


def best_of(
    held: HeldRecords, moves: Sequence[np.ndarray], others: Sequence[np.ndarray],
    enough: Sequence[np.ndarray],
) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:  # fmt: skip
    """Returns the better of two moves of the states, by window, and the residuals there.

    Args:
        held: the windows.
        moves: one array (W, nx) a record.
        others: likewise.
        enough: sums of squares, one array (W,) a record: a window that has no more at `moves` is
            not simulated at `others`.
    """
    residuals = held.residuals(moves)
    # NaN, of a window that diverges, is more than enough
    at = [~(np.sum(r**2, axis=1) <= most) for r, most in zip(residuals, enough, strict=True)]
    best = []
    for one, other, r, r_other, rows in zip(
        moves, others, residuals, held.residuals(others, at), at, strict=True
    ):
        d, r, places = np.array(one), np.array(r), np.flatnonzero(rows)
        squares = np.nan_to_num([np.sum(x**2, axis=1) for x in (r[rows], r_other)], nan=np.inf)
        better = squares[1] < squares[0]
        d[places[better]], r[places[better]] = other[rows][better], r_other[better]
        best.append((d, r))
    return tuple(d for d, _ in best), tuple(r for _, r in best)


def problem(
    plant: Plant,
    records: Sequence[Record],
    shared: Priors,
    own: Priors,
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
        cut = spread(_windows_of(record, length), most)
        first = first_states(predictor, np.array([begun[n] for n in space.names]), cut)
        parts.append(Shooting(predictor, space, cut, first, np.diag(1 / scale), True))
    return Problem(tuple(parts), Unknowns(shared, own, tuple(r.log.name for r in records)))


def _windows_of(record: Record, length: float) -> Windows:
    """Returns the windows of a record that a fit may see, of a length [s].

    A search fits the records that confirm too, to see its effects from the other side; what it
    keeps for its report stays unseen there.

    Raises:
        InputError: there are none.
    """
    cut = windows(record.log, length, record.edge)
    return cut.rows(inside(record.parts, "select", cut.places))


def most_windows(
    plant: Plant, records: Sequence[Record], length: float, most_steps: int = MOST_STEPS
) -> int:
    """Returns the most windows of each record to simulate, so that all take `most_steps`."""
    each = max(length / own_step(plant), 1.0)
    return max(MIN_WINDOWS, int(most_steps / (each * max(1, len(records)))))


def no_moves(problem_: Problem) -> tuple[np.ndarray, ...]:
    """Returns zero moves of the windows' states, one array (W, nx) a record."""
    out = []
    for part in problem_.parts:
        model = part.predictor.plant.model
        out.append(np.zeros((len(part.cut.starts), 2 * model.nv + model.na)))
    return tuple(out)


def with_unknowns(
    problem_: Problem, shared: Priors, own: Priors, fixed: Mapping[str, float]
) -> Problem:
    """Returns the same windows with other free parameters, and other values of those not free."""
    parts, space = [], shared.plus(own).space
    for part in problem_.parts:
        values = {**part.predictor.fixed, **fixed}
        rest = {n: v for n, v in values.items() if n not in space.names}
        predictor = replace(part.predictor, names=space.names, fixed=rest)
        parts.append(replace(part, space=space, predictor=predictor))
    return Problem(tuple(parts), Unknowns(shared, own, problem_.unknowns.records))


def with_longer_steps(
    problem_: Problem, q: np.ndarray, moves: Sequence[np.ndarray], is_for_slopes: bool = False
) -> Problem:
    """Returns the windows with simulation steps as long as predictions and slopes allow.

    Args:
        problem_: of one plant.
        q: where they are compared, shape (p,).
        moves: of the windows' states, one array (W, nx) a record.
        is_for_slopes: whether only simulations for slopes may take longer steps.
    """
    each = [q[problem_.unknowns.columns(k)] for k in range(len(problem_.parts))]
    parts: Sequence[Shooting] = problem_.parts
    if not is_for_slopes:
        parts = with_longest_steps(parts, each, moves)
    return replace(problem_, parts=tuple(with_longest_slope_steps(parts, each, moves)))


def with_own_steps(problem_: Problem) -> Problem:
    """Returns the same windows whose predictions are simulated with the steps of the user's model.

    Slopes may still take longer ones: they only say where a search goes.

    Args:
        problem_: of one plant.
    """
    plant = problem_.plant
    if not isinstance(plant, JointPlant) or plant.steps <= 1:
        return problem_
    own = replace(plant, steps=1)
    parts = (replace(p, predictor=replace(p.predictor, plant=own)) for p in problem_.parts)
    return replace(problem_, parts=tuple(parts))


def with_scale(problem_: Problem, scale: np.ndarray) -> Problem:
    """Returns the same windows whose errors count in units of another scale s, shape (ny,)."""
    whitener = np.diag(1 / scale)
    return replace(problem_, parts=tuple(replace(p, whitener=whitener) for p in problem_.parts))
