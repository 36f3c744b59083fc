"""Windows whose parameters are held: only their initial states are free.

    r_w(d_w) = [ C (y_w - ŷ_w(x̄_w ⊕ d_w)) ; -d_w/s ]        as `identification.windows.shooting`

What the parameters make of the model and of the inputs is computed once, simulations are prepared
once, and windows of several records may be simulated in one batch (`HeldRecords`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np

from identification.errors import DivergenceError
from identification.model.coordinates import NOTHING
from identification.model.paths import Slot
from identification.model.predictor import Numbers, Predictor, settings_of, with_states
from identification.model.protocol import with_numbers
from identification.model.rollout import Simulations, State, hold, simulations, substeps
from identification.model.sensitivity import FORWARD_STEP
from identification.windows.batches import at_own_steps, rough, slower
from identification.windows.shooting import Shooting, Tangent, decomposed
from identification.windows.windows import moved

NO_VALUES = np.zeros((1, 0))  # the value set of a predictor whose values are all fixed


@dataclass(frozen=True)
class HeldRecords:
    """Windows of some records, none of which has a free parameter."""

    parts: tuple[Shooting, ...]  # the windows, one a record
    # indices of records that are simulated in one batch, and their windows together
    groups: tuple[tuple[tuple[int, ...], HeldWindows], ...]

    def residuals(
        self, moves: Sequence[np.ndarray], at: Sequence[np.ndarray] | None = None
    ) -> tuple[np.ndarray, ...]:
        """Returns r at moves of states (W, nx), (W, L ny + nx) a record; NaN where one diverges.

        Only windows of the masks `at`, shape (W,) a record, are simulated and returned.
        """
        masks = at or [np.ones(len(d), bool) for d in moves]
        out: dict[int, np.ndarray] = {}
        for records, held in self.groups:
            some = np.concatenate([masks[k] for k in records])
            d = np.concatenate([moves[k] for k in records])[some]
            part = held if some.all() else held.rows(some)
            r = part.residual(d) if some.any() else np.zeros((0, held.size + d.shape[1]))
            out |= {k: r[part.record == i] for i, k in enumerate(records)}
        return tuple(out[k] for k in range(len(self.parts)))


def held_records(parts: Sequence[Shooting]) -> HeldRecords:
    """Returns the windows of some records with parameters held, grouped into batches."""
    settings = settings_of([part.predictor for part in parts], [NO_VALUES] * len(parts))
    each = [_held(part, numbers) for part, (_, numbers) in zip(parts, settings, strict=True)]
    groups: list[tuple[tuple[int, ...], HeldWindows]] = []
    rest = list(range(len(each)))
    while rest:
        alike = tuple(k for k in rest if _is_alike(each[rest[0]], each[k]))
        rest = [k for k in rest if k not in alike]
        groups.append((alike, _together([each[k] for k in alike])))
    return HeldRecords(tuple(parts), tuple(groups))


@dataclass(frozen=True, kw_only=True)
class HeldWindows:
    """The data that do not change while the initial states of windows are sought."""

    predictors: tuple[Predictor, ...]  # of each record, all parameters held
    has_rough_slopes: bool  # see `Shooting`
    every: int  # inputs per sample
    hold_kind: str  # of the inputs
    record: np.ndarray  # which record each window is of, shape (W,)
    # model entries and their values of the whole, shape (W,)
    numbers: tuple[tuple[Slot, np.ndarray], ...]
    times: np.ndarray  # when each window begins in its record, shape (W,) [s]
    inputs: np.ndarray  # of the whole, shape (W, steps, nu)
    outputs: np.ndarray  # what was measured, shape (W, L, ny)
    first: State  # the states where the windows are believed to begin, W rows
    weight: np.ndarray  # 1/s of each tangent coordinate, shape (W, nx)
    whitener: np.ndarray  # C, shape (ny, ny)
    # the windows of which these are some, which know their simulations; None for itself
    whole: HeldWindows | None = None
    at: np.ndarray | None = None  # which of them, shape (W,)

    def rows(self, keep: np.ndarray) -> HeldWindows:
        """Returns some of the windows, by mask or by index."""
        whole = self.whole or self
        at = (np.arange(len(self.record)) if self.at is None else self.at)[keep]
        some = replace(
            self, whole=whole, at=at, record=self.record[keep], times=self.times[keep],
            outputs=self.outputs[keep], weight=self.weight[keep],
            first=self.first.rows(keep),
        )  # fmt: skip
        if np.all(np.diff(at) > 0):
            return some
        # a window that is there twice is simulated twice: nobody has prepared that
        numbers = tuple((slot, column[at]) for slot, column in whole.numbers)
        return replace(some, whole=None, at=None, inputs=whole.inputs[at], numbers=numbers)

    @property
    def model(self) -> mujoco.MjModel:
        """The plant's model."""
        return self.predictors[0].plant.model

    @property
    def size(self) -> int:
        """Outputs of a window, L ny."""
        return int(np.prod(self.outputs.shape[1:]))

    def residual(self, d: np.ndarray) -> np.ndarray:
        """Returns r of all windows at d (W, nx), shape (W, L ny + nx); NaN where one diverges."""
        return self._joined(self._simulated((self.whole or self).for_residuals, [d])[0], d)

    def slopes(self, d: np.ndarray, r: np.ndarray) -> Tangent:
        """Returns all windows linearised at d (W, nx), where their residual is r (W, m), without S.

        Raises:
            DivergenceError: a window beside them diverges.
        """
        h, whole = FORWARD_STEP, self.whole or self
        moves = [d, *(d + h * e for e in np.eye(d.shape[1]))]
        y = self._simulated(whole.for_slopes, moves)
        if not np.isfinite(y).all():  # longer steps may diverge where the model's own do not
            slow = at_own_steps(rough(self.predictors[0].plant), self.model)
            y = self._simulated(whole.prepared(slow, len(moves)), moves)
        each = np.stack([self._joined(*p) for p in zip(y, moves, strict=True)], axis=-1)
        if not np.isfinite(each).all():
            raise DivergenceError(
                "the simulation of a window diverged beside its best start; use a smaller step, or"
                " values nearer to the nominal ones"
            )
        X = (each[..., :1] - each[..., 1:]) / h
        return decomposed(r, X, np.zeros((*r.shape, 0)))

    def _joined(self, y: np.ndarray, d: np.ndarray) -> np.ndarray:
        error = (self.outputs - y) @ self.whitener.T
        return np.hstack([error.reshape(len(d), -1), -d * self.weight])

    @cached_property
    def for_residuals(self) -> Prepared:
        """Simulations for residuals."""
        return self.prepared(self.model, 1)

    @cached_property
    def for_slopes(self) -> Prepared:
        """Simulations for slopes."""
        model = rough(self.predictors[0].plant) if self.has_rough_slopes else self.model
        return self.prepared(model, 1 + self.weight.shape[1])

    def prepared(self, model: mujoco.MjModel, moves: int) -> Prepared:
        """Returns the simulations of a model for a number of moves of each window."""
        inputs, every = slower(self.inputs, self.every, self.model, model)
        n = substeps(self.predictors[0].log.sampling_time / every, model.opt.timestep)
        numbers = [(slot, np.tile(column, moves)) for slot, column in self.numbers]
        if all(np.all(column == column[0]) for _, column in numbers):
            model, numbers = with_numbers(model, numbers, 0), []
        made = simulations(model, moves * len(self.record), numbers)
        return Prepared(made, hold(inputs, n, self.hold_kind), n * every)

    @cached_property
    def _different(self) -> tuple[tuple[Predictor, np.ndarray], ...]:
        """Predictors whose values differ, and the windows that each tells, a mask (W,)."""
        fixed = [p.fixed for p in self.predictors]
        first = [fixed.index(values) for values in fixed]
        which = np.array(first)[self.record]
        return tuple((self.predictors[k], which == k) for k in dict.fromkeys(first))

    def _simulated(self, prepared: Prepared, moves: Sequence[np.ndarray]) -> np.ndarray:
        """Returns outputs of k moves of the states, shape (k, W, L, ny)."""
        W, k = len(self.record), len(moves)
        starts = State.stacked([moved(self.model, self.first, d) for d in moves])
        parts = [(p, np.tile(rows, k)) for p, rows in self._different]
        for predictor, rows in parts if with_states(self.predictors[0].plant) else ():
            first = predictor.begun(NO_VALUES, starts.rows(rows))
            for field in ("qpos", "qvel", "act"):
                getattr(starts, field)[rows] = getattr(first, field)
        at, times = np.arange(W) if self.at is None else self.at, np.tile(self.times, k)
        simulated = np.concatenate([at + j * len(prepared.controls) for j in range(k)])
        run = prepared.simulations.run(
            starts, np.tile(prepared.controls[at], (k, 1, 1)), prepared.every,
            self.predictors[0].recorded, times, simulated, keeps_diverged=True,
        )  # fmt: skip
        y = np.empty((k * W, *self.outputs.shape[1:]))
        for predictor, rows in parts:
            if rows.any():
                states = {f: x[rows] for f, x in run.items()}
                y[rows] = predictor.outputs(NO_VALUES, states, times[rows])
        return y.reshape(k, W, *y.shape[1:])


def held_windows(part: Shooting) -> HeldWindows:
    """Returns the windows of a record that has no free parameter."""
    return _held(part, part.predictor.settings(NO_VALUES)[1])


def _held(part: Shooting, numbers: Numbers) -> HeldWindows:
    """Returns the windows of a record, whose parameters make these numbers of its model."""
    predictor, W = part.predictor, len(part.cut.starts)
    inputs, every, hold_kind = part.held_inputs(NO_VALUES)
    return HeldWindows(
        predictors=(predictor,), has_rough_slopes=part.has_rough_slopes, every=every,
        hold_kind=hold_kind,
        record=np.zeros(W, int), times=part.times, inputs=inputs, outputs=part.cut.outputs,
        numbers=tuple((slot, np.repeat(column, W)) for slot, column in numbers),
        first=part.first.states, weight=np.tile(part.first.weight, (W, 1)), whitener=part.whitener,
    )  # fmt: skip


@dataclass(frozen=True)
class Prepared:
    """Simulations of all windows, several of each."""

    simulations: Simulations  # of the first move of all windows, then of the next move
    controls: np.ndarray  # of each window at each step, shape (W, steps, nu)
    every: int  # steps of a sample


def at_values(part: Shooting, q: np.ndarray) -> Shooting:
    """Returns the windows of a record with all parameters held at q (p,), in coordinates."""
    names = part.predictor.names
    values = dict(zip(names, part.space.decode(q).tolist(), strict=True))
    predictor = replace(part.predictor, names=(), fixed={**part.predictor.fixed, **values})
    return replace(part, predictor=predictor, space=NOTHING)


def _is_alike(one: HeldWindows, other: HeldWindows) -> bool:
    """Returns whether the windows of two records can be simulated in one batch."""
    return (
        one.predictors[0].plant is other.predictors[0].plant
        and [slot for slot, _ in one.numbers] == [slot for slot, _ in other.numbers]
        and one.outputs.shape[1:] == other.outputs.shape[1:]
        and one.inputs.shape[1:] == other.inputs.shape[1:]
        and (one.every, one.hold_kind, one.has_rough_slopes)
        == (other.every, other.hold_kind, other.has_rough_slopes)
        and one.predictors[0].log.sampling_time == other.predictors[0].log.sampling_time
        and one.predictors[0].log.output_names == other.predictors[0].log.output_names
        and np.array_equal(one.whitener, other.whitener)
    )


def _together(each: Sequence[HeldWindows]) -> HeldWindows:
    """Returns the windows of several records that are alike, one record after the other."""
    columns = zip(*([column for _, column in h.numbers] for h in each), strict=True)
    slots = [slot for slot, _ in each[0].numbers]

    def rows(name: str) -> np.ndarray:
        return np.concatenate([getattr(h, name) for h in each])

    return replace(
        each[0], predictors=tuple(h.predictors[0] for h in each),
        first=State.stacked([h.first for h in each]),
        record=np.repeat(np.arange(len(each)), [len(h.record) for h in each]),
        numbers=tuple((s, np.concatenate(c)) for s, c in zip(slots, columns, strict=True)),
        times=rows("times"), inputs=rows("inputs"), outputs=rows("outputs"), weight=rows("weight"),
    )  # fmt: skip
