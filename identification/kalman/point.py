"""A plant at one set of values: residual, sensitivities and linearisation along the trajectory.

    e = y - ŷ(q),   Φ = ∂ŷ/∂q,   δx_{k+1} = A_k δx_k + B_k δu_k
    Φ_j = (ŷ(q + h e_j) - ŷ(q))/h        by simulations, or by the sensitivity equations

Few columns are simulated, which is exact. Where many are asked, or where others are borrowed from a
point nearby, they come from the sensitivity equations if these agree with a simulation along all of
them at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.kalman.linear import (
    Linearisation,
    LinearPlant,
    extend,
    join,
    join_plants,
    linearise_along,
)
from identification.kalman.sensitivity_equations import can_solve, solve_sensitivities
from identification.kalman.trajectory import Run
from identification.logs.joined import records_of
from identification.logs.log import Log
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import STEP

# Of STEP, and of an effect's probe, for differences of accelerations: large ones nearly cancel each
# other, such as those of an anchor that moves and of the cable that is longer at rest for it.
EQUATION_STEP_SHARE = 1e-2
MAX_SIMULATED_COLUMNS = 12  # with more, the sensitivity equations are worth it


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
    """Simulate a plant at q (p,), with its sensitivities and its linearisation.

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


def shift_point(point: Point, q: np.ndarray, run: Run) -> Point | None:
    """Returns the point after a short step, with the columns and the linearisation from before it.

    None where the outputs do not go where the columns say: they no longer hold.
    """
    inside = point.space.inside(q)
    e = point.log.outputs - run.outputs
    expected, found = point.J @ (inside - point.q), point.e - e
    if np.linalg.norm(found - expected) > SLOPE_ERROR * np.linalg.norm(found):
        return None
    return replace(point, q=inside, e=e, is_borrowed=True)


def is_costly(point: Point) -> bool:
    """Returns whether a point has so many columns that they are kept after a short step."""
    return len(point.q) > MAX_SIMULATED_COLUMNS


def evaluate_sensitivities(point: Point, whole: Log) -> np.ndarray:
    """Returns J of the same point on a longer log, shape (N, ny, p)."""
    run = Run(replace(point.predictor, log=whole), point.space.decode(point.q))
    return compute_columns(run.predictor, point.space, point.q, _linearise(run), {}, run.outputs)


def extend_point(point: Point, whole: Log) -> Point:
    """Returns the same point on a longer log, without J; known beginnings of records are kept."""
    run = Run(replace(point.predictor, log=whole), point.space.decode(point.q))
    known, each = _known_plants(point), []
    for (number, log), (record, _), along in zip(
        records_of(whole), run.predictor.records(), run.along, strict=True
    ):
        start, plant = known.get(number, (None, None))
        if plant is None or start != log.begun:
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
        rows = slice(done, done + len(log) - 1)
        out[number] = log.begun, replace(linear, A=linear.A[rows], B=linear.B[rows])
        done += len(log)
    return out


def _linearise(run: Run) -> tuple[Linearisation, ...]:
    """Returns the linearisation of each record along a simulation."""
    each = zip(run.predictor.records(), run.along, strict=True)
    return tuple(linearise_along(record, along) for (record, _), along in each)


def _known(near: Point | None, small: frozenset[str]) -> dict[str, np.ndarray]:
    """Returns the columns of J that hold at a point nearby, by name, each (N, ny)."""
    if near is None:
        return {}
    columns = zip(near.space.names, np.moveaxis(near.J, 2, 0), strict=True)
    return {name: column for name, column in columns if name in small}


def compute_columns(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    known: Mapping[str, np.ndarray], predicted: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Computes J (N, ny, p); columns that are known, by name, are not computed."""
    asked = np.array([name not in known for name in space.names])
    J = np.empty((*predictor.log.outputs.shape, len(q)))
    for j in np.flatnonzero(~asked):
        J[..., j] = known[space.names[j]]
    moves = np.diag(np.where(q + STEP > space.upper, -STEP, STEP))[asked]
    # Columns that are borrowed are of a point nearby: those beside them need not be exact either.
    if (len(moves) > MAX_SIMULATED_COLUMNS or known) and can_solve(predictor, records):
        short = EQUATION_STEP_SHARE * moves
        S = _solve(predictor, space, q, records, short, short.sum(axis=1))
        to = space.inside(q + STEP * _along(S, asked))
        (ahead,) = predictor.predict(space.decode(to[None]))
        if _agree(S @ (to - q)[asked], ahead - predicted):
            J[..., asked] = S
            return J
    if not len(moves):
        return J
    runs = predictor.predict(space.decode(q + moves))
    moved = (runs - predicted) / moves.sum(axis=1)[:, None, None]
    J[..., asked] = np.moveaxis(moved, 0, -1)
    return J


def do_equations_hold(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    J: np.ndarray,
) -> bool:  # fmt: skip
    """Returns whether the sensitivity equations agree with all columns of J (N, ny, p) at once.

    They do not where a joint hits its limit.
    """
    if not J.size or not can_solve(predictor, records):
        return False
    to = space.inside(q + EQUATION_STEP_SHARE * STEP * _along(J, np.ones(len(q), bool)))
    size = np.array([EQUATION_STEP_SHARE * STEP])
    solved = _solve(predictor, space, q, records, (to - q)[None], size)[..., 0]
    return _agree(solved * size, J @ (to - q))


def _solve(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    moves: np.ndarray, size: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Solves the sensitivity equations for m moves (m, p) of q, of some sizes, (N, ny, m)."""
    changed = space.decode(q + moves)
    return solve_sensitivities(predictor, records, space.decode(q), changed, size)


def _along(columns: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Returns a direction of q with entries up to 1, to which all columns add alike, shape (p,)."""
    size = np.sqrt(np.mean(columns**2, axis=(0, 1)))
    signs = np.random.default_rng(0).choice([-1.0, 1.0], len(size))
    weight = np.where(size > 0, signs / np.where(size > 0, size, 1.0), 0.0)
    out = np.zeros(len(asked))
    out[asked] = weight / np.abs(weight).max(initial=1e-300)
    return out


def _agree(one: np.ndarray, other: np.ndarray) -> bool:
    """Returns whether two changes of the outputs agree to a relative error of `SLOPE_ERROR`."""
    return bool(np.linalg.norm(one - other) <= SLOPE_ERROR * np.linalg.norm(other))
