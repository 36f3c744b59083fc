"""Simulations whose steps are longer than the model's own, as far as their purpose allows.

    ‖y_n - y_1‖ <= ε_y ‖y - y_1‖     for each output: simulations of predictions
    ‖S_n - S_1‖ <= ε_S ‖S_1‖         for each column of the tangent: simulations for slopes

Index n: n steps of the model in one. What the model leaves unexplained is so much larger than the
error of the steps that the latter adds less than ε_y² of its mean square. Slopes only say where a
search goes: with a relative error ε_S a step of Gauss and Newton leaves ε_S of the way, and misses
ε_S² of what the criterion can gain (inexact Newton; Dembo, Eisenstat, Steihaug 1982).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from identification.effects.plant.jointed import JointPlant
from identification.errors import DivergenceError
from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.model.predictor import Plant
from identification.model.rollout import substeps
from identification.windows.shooting import Shooting, tangent

OUTPUT_ERROR = 0.05  # ε_y; its square is a tenth of the fall from which an effect matters
COMPARED_WINDOWS = 10  # on which slopes are compared


def own_step(plant: Plant) -> float:
    """Returns the time step of the user's model [s], whatever steps simulations take."""
    model = plant.bare.model if isinstance(plant, JointPlant) else plant.model
    return float(model.opt.timestep)


def steps_of(plant: Plant) -> tuple[float, float]:
    """Returns the time steps of the simulations of a plant and of the user's model [s]."""
    return float(plant.model.opt.timestep), own_step(plant)


def with_longest_steps(
    parts: Sequence[Shooting], q: Sequence[np.ndarray], d: Sequence[np.ndarray]
) -> list[Shooting]:
    """Returns the windows with the longest steps that change predictions by less than ε_y.

    Args:
        parts: windows of each record, all of one plant.
        q: the parameters of each, shape (p,).
        d: moves of the states of its windows, shape (W, nx).
    """
    plant = parts[0].predictor.plant
    if not isinstance(plant, JointPlant):
        return [*parts]

    def outputs(n: int) -> list[np.ndarray]:
        each = zip(_of(parts, replace(plant, steps=n)), q, d, strict=True)
        return [part.outputs(one[None], [move])[0] for part, one, move in each]

    exact = outputs(1)
    unexplained = _norms([part.cut.outputs - y for part, y in zip(parts, exact, strict=True)])

    def differs(n: int) -> bool:
        errors = [y_n - y for y, y_n in zip(exact, outputs(n), strict=True)]
        return bool(np.any(_norms(errors) > OUTPUT_ERROR * unexplained))

    return _of(parts, replace(plant, steps=_most(_steps(parts), differs)))


def with_longest_slope_steps(
    parts: Sequence[Shooting], q: Sequence[np.ndarray], d: Sequence[np.ndarray]
) -> list[Shooting]:
    """Returns the windows with the longest steps that change slopes by less than ε_S."""
    plant = parts[0].predictor.plant
    if not isinstance(plant, JointPlant):
        return [*parts]
    count = max(2, COMPARED_WINDOWS // len(parts))
    some = [np.unique(np.linspace(0, len(move) - 1, count).astype(int)) for move in d]
    few = [part.rows(at) for part, at in zip(parts, some, strict=True)]

    def slopes(n: float) -> list[np.ndarray]:
        each = zip(_of(few, replace(plant, slope_steps=n)), q, d, some, strict=True)
        return [_columns(part, one, move[at]) for part, one, move, at in each]

    exact = slopes(plant.steps)

    def differs(n: int) -> bool:
        pairs = zip(exact, slopes(n), strict=True)
        return any(np.any(_norms([S_n - S]) > SLOPE_ERROR * _norms([S])) for S, S_n in pairs)

    each = (n for n in _steps(parts) if n % plant.steps == 0)
    return _of(parts, replace(plant, slope_steps=max(plant.steps, _most(each, differs))))


def _steps(parts: Sequence[Shooting]) -> Iterator[int]:
    """Returns numbers of steps of the model, above one, that divide all records' samples."""
    each = [
        substeps(part.predictor.log.sampling_time, own_step(part.predictor.plant)) for part in parts
    ]
    return (n for n in range(2, min(each) + 1) if all(k % n == 0 for k in each))


def _most(each: Iterator[int], differs: Callable[[int], bool]) -> int:
    """Returns the largest of some numbers before the first that differs; one when there is none."""
    best = 1
    for n in each:
        try:
            if differs(n):
                break
        except DivergenceError:
            break
        best = n
    return best


def _norms(each: Sequence[np.ndarray]) -> np.ndarray:
    """Returns the norm of each column (last axis) over all rows of some arrays."""
    rows = np.concatenate([x.reshape(-1, x.shape[-1]) for x in each])
    return np.asarray(np.linalg.norm(rows, axis=0))


def _of(parts: Sequence[Shooting], plant: JointPlant) -> list[Shooting]:
    """Returns the windows of each record under another plant, which all share."""
    return [replace(part, predictor=replace(part.predictor, plant=plant)) for part in parts]


def _columns(part: Shooting, q: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Returns slopes of states and parameters, shape (W m, nx + p)."""
    t = tangent(part, q, d)
    X = (t.U * t.s[:, None]) @ t.Vt * t.size[:, None]
    S = np.concatenate([X, t.S], axis=2)
    return np.asarray(S.reshape(-1, S.shape[2]))
