"""A plant at one set of values: residual, sensitivities and linearisation along the trajectory.

e = y - ŷ(q),   Φ = ∂ŷ/∂q,   δx_{k+1} = A_k δx_k + B_k δu_k
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.kalman.columns import MAX_SIMULATED_COLUMNS, compute_columns
from identification.kalman.linear import (
    Linearisation,
    LinearPlant,
    extend,
    join,
    join_plants,
    linearise_along,
)
from identification.kalman.run import Run
from identification.logs.joined import records_of
from identification.logs.log import Log
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor


@dataclass(frozen=True, kw_only=True, eq=False)
class Point:
    """A plant evaluated at the coordinates q of its free parameters.

    Attributes:
        predictor: plant, log, and names of the free parameters.
        space: coordinates of the free parameters.
        q: the point, shape (p,).
        e: residual, shape (N, ny).
        J: sensitivities Φ, shape (N, ny, p).
        linear: the plant linearised along its trajectory.
        small: free parameters that stay small, such as deviations of single drives: the outputs
            are nearly linear in them, and their columns of J hold at points nearby as well.
        is_borrowed: whether columns of J are those of a point nearby.
    """

    predictor: Predictor
    space: Coordinates
    q: np.ndarray
    e: np.ndarray
    J: np.ndarray
    linear: LinearPlant
    small: frozenset[str] = frozenset()
    is_borrowed: bool = False

    @property
    def log(self) -> Log:
        """The log that the residual belongs to."""
        return self.predictor.log

    @property
    def motion(self) -> float:
        """Returns the std of the logged inputs over time, rms of all; 0 where there are none."""
        inputs = self.log.inputs
        return float(np.sqrt(np.mean(np.var(inputs, axis=0)))) if inputs.size else 0.0

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters that are not the plant's own, in their units."""
        free = dict(zip(self.space.names, self.space.decode(self.q).tolist(), strict=True))
        return {**self.predictor.fixed, **free}


def evaluate_point(
    predictor: Predictor, space: Coordinates, q: np.ndarray, near: Point | None = None,
    small: frozenset[str] = frozenset(), run: Run | None = None,
) -> Point:  # fmt: skip
    """Simulate a plant at q, with its sensitivities and its linearisation.

    Args:
        predictor: plant, log and free parameters.
        space: coordinates of the free parameters.
        q: shape (p,).
        near: a point nearby on the same log, from which columns of small parameters are taken.
        small: see `Point`.
        run: the simulation at q, where there is one already.

    Raises:
        DivergenceError: a simulation left the finite numbers.
    """
    inside = space.inside(q)
    run = run or Run(predictor, space.decode(inside))
    records = _linearise(run)
    known = _known(near, small)
    J = compute_columns(predictor, space, inside, records, known, run.outputs)
    return Point(
        predictor=predictor,
        space=space,
        q=inside,
        e=predictor.log.outputs - run.outputs,
        J=J,
        linear=join(records),
        small=small,
        is_borrowed=bool(known),
    )


def _linearise(run: Run) -> tuple[Linearisation, ...]:
    """Returns the linearisation of each record along a simulation."""
    each = zip(run.predictor.records(), run.along, strict=True)
    return tuple(linearise_along(record, along) for (record, _), along in each)


def is_costly(point: Point) -> bool:
    """Returns whether a point has so many columns that they are kept after a short step."""
    return len(point.q) > MAX_SIMULATED_COLUMNS


def shift_point(point: Point, q: np.ndarray, run: Run | None = None) -> Point | None:
    """Returns the point after a short step, with the columns and the linearisation from before it.

    Args:
        point: the point before the step.
        q: shape (p,).
        run: the simulation at q, where there is one already.

    Returns:
        None where the outputs do not go where the columns say: they no longer hold.

    Raises:
        DivergenceError: the simulation left the finite numbers.
    """
    inside = point.space.inside(q)
    run = run or Run(point.predictor, point.space.decode(inside))
    e = point.log.outputs - run.outputs
    expected, found = point.J @ (inside - point.q), point.e - e
    if np.linalg.norm(found - expected) > SLOPE_ERROR * np.linalg.norm(found):
        return None
    return replace(point, q=inside, e=e, is_borrowed=True)


def _known(near: Point | None, small: frozenset[str]) -> dict[str, np.ndarray]:
    """Returns the columns of J that hold at a point nearby, by name, each (N, ny)."""
    if near is None:
        return {}
    columns = zip(near.space.names, np.moveaxis(near.J, 2, 0), strict=True)
    return {name: column for name, column in columns if name in small}


def evaluate_sensitivities(point: Point, whole: Log) -> np.ndarray:
    """Returns J of the same point on a longer log, shape (N, ny, p)."""
    run = Run(replace(point.predictor, log=whole), point.space.decode(point.q))
    return compute_columns(run.predictor, point.space, point.q, _linearise(run), {}, run.outputs)


def extend_point(point: Point, whole: Log) -> Point:
    """Returns the same point on a longer log, of which its own log is a part; without J.

    The linearisation of its own log is kept where that is the beginning of a record.

    Args:
        point: the plant on its own log.
        whole: the longer log.

    Raises:
        DivergenceError: the simulation of the longer log left the finite numbers.
    """
    run = Run(replace(point.predictor, log=whole), point.space.decode(point.q))
    known, each = _known_plants(point), []
    for (number, log), (record, _), along in zip(
        records_of(whole), run.predictor.records(), run.along, strict=True
    ):
        begun, plant = known.get(number, (None, None))
        if plant is None or begun != log.begun:
            plant = linearise_along(record, along).at_samples()
        else:
            plant = extend(plant, record, along)
        each.append(plant)
    return Point(
        predictor=run.predictor,
        space=point.space,
        q=point.q,
        e=whole.outputs - run.outputs,
        J=point.J[:0],
        linear=join_plants(each),
    )


def _known_plants(point: Point) -> dict[int, tuple[float, LinearPlant]]:
    """Returns the start [s] and linearisation of each record of a point's log, by its number."""
    out, done, linear = {}, 0, point.linear
    for number, log in records_of(point.log):
        own = slice(done, done + len(log) - 1)
        out[number] = log.begun, replace(linear, A=linear.A[own], B=linear.B[own])
        done += len(log)
    return out
