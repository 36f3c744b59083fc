"""Windows whose parameters are held: only their initial states are free.

    r_w(d_w) = [ C (y_w - ŷ_w(x̄_w ⊕ d_w)) ; -d_w/s ]        as `identification.windows.shooting`

What the parameters make of the model and of the inputs is computed once, and windows of several
records may be simulated in one batch (`identification.windows.held_records`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import mujoco
import numpy as np

from identification.errors import DivergenceError
from identification.model.coordinates import NOTHING
from identification.model.lean import lean
from identification.model.paths import Slot
from identification.model.predictor import Predictor, with_states
from identification.model.rollout import State, rollout
from identification.model.sensitivity import FORWARD_STEP
from identification.windows.shooting import Shooting, at_own_steps, rough, slower
from identification.windows.tangents import Tangent, decomposed
from identification.windows.windows import moved

_NONE = np.zeros((1, 0))  # values of no free parameter


@dataclass(frozen=True, kw_only=True)
class HeldWindows:
    """What does not change while the initial states of windows are sought.

    Attributes:
        predictors: of each record, all parameters held.
        model: the plant's.
        for_slopes: the model whose simulations' differences make slopes.
        every: inputs per sample.
        hold_kind: of the inputs.
        record: which record each window is of, shape (W,).
        numbers: model entries and their values, shape (W,).
        times: when each window begins in its record, shape (W,) [s].
        inputs: shape (W, steps, nu).
        outputs: what was measured, shape (W, L, ny).
        first: the states where the windows are believed to begin, W rows.
        weight: 1/s of each tangent coordinate, shape (W, nx).
        whitener: C, shape (ny, ny).
    """

    predictors: tuple[Predictor, ...]
    model: mujoco.MjModel
    for_slopes: mujoco.MjModel
    every: int
    hold_kind: str
    record: np.ndarray
    numbers: tuple[tuple[Slot, np.ndarray], ...]
    times: np.ndarray
    inputs: np.ndarray
    outputs: np.ndarray
    first: State
    weight: np.ndarray
    whitener: np.ndarray

    def rows(self, keep: np.ndarray) -> HeldWindows:
        """Some of the windows, by mask or by index."""
        return replace(
            self, record=self.record[keep], times=self.times[keep], inputs=self.inputs[keep],
            outputs=self.outputs[keep], weight=self.weight[keep],
            numbers=tuple((slot, column[keep]) for slot, column in self.numbers),
            first=State(*(getattr(self.first, f.name)[keep] for f in fields(State))),
        )  # fmt: skip

    @property
    def size(self) -> int:
        """Outputs of a window, L ny."""
        return int(np.prod(self.outputs.shape[1:]))

    def residual(self, d: np.ndarray) -> np.ndarray:
        """r of all windows at d (W, nx), shape (W, L ny + nx); NaN where one diverges."""
        return self._joined(self._simulated(self.model, [d])[0], d)

    def slopes(self, d: np.ndarray, r: np.ndarray) -> Tangent:
        """All windows linearised at d (W, nx), where their residual is r (W, m), without S.

        Raises:
            DivergenceError: a window beside them diverges.
        """
        h = FORWARD_STEP
        moves = [d, *(d + h * e for e in np.eye(d.shape[1]))]
        y = self._simulated(self.for_slopes, moves)
        if not np.isfinite(y).all():  # longer steps may diverge where the model's own do not
            y = self._simulated(at_own_steps(self.for_slopes, self.model), moves)
        each = np.stack([self._joined(*p) for p in zip(y, moves, strict=True)], axis=-1)
        if not np.isfinite(each).all():
            raise DivergenceError(
                "the simulation of a window diverged beside its best start; use a smaller step, or"
                " values nearer to the nominal ones"
            )
        X = (each[..., :1] - each[..., 1:]) / h
        return decomposed(r, X, np.zeros((*r.shape, 0)))

    def _joined(self, y: np.ndarray, d: np.ndarray) -> np.ndarray:
        left = (self.outputs - y) @ self.whitener.T
        return np.hstack([left.reshape(len(d), -1), -d * self.weight])

    def _simulated(self, model: mujoco.MjModel, moves: Sequence[np.ndarray]) -> np.ndarray:
        """Outputs of k moves of the states, shape (k, W, L, ny)."""
        W, k = len(self.record), len(moves)
        starts = [moved(self.model, self.first, d) for d in moves]
        begun = State(*(np.concatenate([getattr(s, f.name) for s in starts])
                        for f in fields(State)))  # fmt: skip
        parts = [(p, np.tile(self.record == i, k)) for i, p in enumerate(self.predictors)]
        for predictor, own in parts if with_states(self.predictors[0].plant) else ():
            rows = State(*(getattr(begun, f.name)[own] for f in fields(State)))
            for f in fields(State):
                getattr(begun, f.name)[own] = getattr(predictor.begun(_NONE, rows), f.name)
        log = self.predictors[0].log
        inputs, every = slower(self.inputs, self.every, self.model, model)
        run = rollout(
            model, begun, np.tile(inputs, (k, 1, 1)), log.sampling_time / every,
            numbers=[(slot, np.tile(column, k)) for slot, column in self.numbers],
            record=self.predictors[0].recorded, hold_kind=self.hold_kind,
            time=np.tile(self.times, k), keeps_diverged=True,
        )  # fmt: skip
        run = {field: states[:, ::every] for field, states in run.items()}
        y = np.empty((k * W, *self.outputs.shape[1:]))
        for predictor, own in parts:
            if own.any():
                mine = {f: x[own] for f, x in run.items()}
                y[own] = predictor.outputs(_NONE, mine, np.tile(self.times, k)[own])
        return y.reshape(k, W, *y.shape[1:])


def at_values(part: Shooting, q: np.ndarray) -> Shooting:
    """The windows of a record with all parameters held at q (p,), in coordinates."""
    names = part.predictor.names
    values = dict(zip(names, part.space.decode(q).tolist(), strict=True))
    predictor = replace(part.predictor, names=(), fixed={**part.predictor.fixed, **values})
    return replace(part, predictor=predictor, space=NOTHING)


def held_windows(part: Shooting) -> HeldWindows:
    """The windows of a record that has no free parameter."""
    predictor, W = part.predictor, len(part.cut.starts)
    _, numbers = predictor.settings(_NONE)
    inputs, every, hold_kind = part.held_inputs(_NONE)
    exact = lean(predictor.plant.model, numbers)
    return HeldWindows(
        predictors=(predictor,), model=exact, every=every, hold_kind=hold_kind,
        for_slopes=lean(rough(predictor.plant), numbers) if part.has_rough_slopes else exact,
        record=np.zeros(W, int), times=part.times, inputs=inputs, outputs=part.cut.outputs,
        numbers=tuple((slot, np.repeat(column, W)) for slot, column in numbers),
        first=part.first.states, weight=np.tile(part.first.weight, (W, 1)), whitener=part.whitener,
    )  # fmt: skip
