"""A plant at one set of values: residual, sensitivities and linearisation along the trajectory.

e = y - ŷ(q),   Φ = ∂ŷ/∂q,   δx_{k+1} = A_k δx_k + B_k δu_k
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.kalman.linear import (
    Linearisation,
    LinearPlant,
    join,
    linearise,
    linearise_records,
)
from identification.kalman.sensitivity_equations import can_solve, solve_sensitivities
from identification.logs.log import Log
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor

STEP = 1e-4  # of q, for forward differences of simulations
# The same for differences of accelerations, as a share: large ones nearly cancel each other, such
# as those of an anchor that moves and of the cable that is longer at rest for it.
SHORTER = 1e-2
HOLDS = 0.1  # share by which outputs may miss what the columns of a point say of a short step
MANY = 30  # columns, beyond which the equations are worth it: fewer are simulated, which is exact
WRONG = 0.1  # share by which a simulation may differ from the sensitivity equations


@dataclass(frozen=True, kw_only=True)
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
        by_equations: whether the sensitivity equations hold here.
    """

    predictor: Predictor
    space: Coordinates
    q: np.ndarray
    e: np.ndarray
    J: np.ndarray
    linear: LinearPlant
    small: frozenset[str] = frozenset()
    by_equations: bool = False

    @property
    def log(self) -> Log:
        """The log that the residual belongs to."""
        return self.predictor.log

    @property
    def motion(self) -> float:
        """Std of the logged inputs over time, rms of all."""
        return float(np.sqrt(np.mean(np.var(self.log.inputs, axis=0))))

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters that are not the plant's own, in their units."""
        free = dict(zip(self.space.names, self.space.decode(self.q).tolist(), strict=True))
        return {**self.predictor.fixed, **free}


def evaluate_point(
    predictor: Predictor, space: Coordinates, q: np.ndarray, near: Point | None = None,
    small: frozenset[str] = frozenset(),
) -> Point:  # fmt: skip
    """Simulate a plant at q, with its sensitivities and its linearisation.

    Args:
        predictor: plant, log and free parameters.
        space: coordinates of the free parameters.
        q: shape (p,).
        near: a point nearby on the same log, from which columns of small parameters are taken.
        small: see `Point`.

    Raises:
        DivergenceError: a simulation left the finite numbers.
    """
    inside = space.inside(q)
    records = linearise_records(predictor, space.decode(inside))
    predicted, J, solved = _sensitivities(predictor, space, inside, records, _known(near, small))
    return Point(
        predictor=predictor,
        space=space,
        q=inside,
        e=predictor.log.outputs - predicted,
        J=J,
        linear=join(records),
        small=small,
        by_equations=solved,
    )


def is_costly(point: Point) -> bool:
    """Whether a point has so many columns that they are kept after a short step."""
    return len(point.q) > MANY


def shift_point(point: Point, q: np.ndarray) -> Point | None:
    """The point after a short step, with the columns and the linearisation from before it.

    Args:
        point: the point before the step.
        q: shape (p,).

    Returns:
        None where the outputs do not go where the columns say: they no longer hold.

    Raises:
        DivergenceError: the simulation left the finite numbers.
    """
    inside = point.space.inside(q)
    e = point.log.outputs - point.predictor.predict(point.space.decode(inside))[0]
    expected, found = point.J @ (inside - point.q), point.e - e
    if np.linalg.norm(found - expected) > HOLDS * np.linalg.norm(found):
        return None
    return replace(point, q=inside, e=e)


def _known(near: Point | None, small: frozenset[str]) -> dict[str, np.ndarray]:
    """Columns of J that hold at a point nearby, by name, each (N, ny)."""
    if near is None:
        return {}
    columns = zip(near.space.names, np.moveaxis(near.J, 2, 0), strict=True)
    return {name: column for name, column in columns if name in small}


def evaluate_sensitivities(point: Point, whole: Log) -> np.ndarray:
    """J of the same point on a longer log, shape (N, ny, p)."""
    predictor = replace(point.predictor, log=whole)
    records = linearise_records(predictor, point.space.decode(point.q))
    return _sensitivities(predictor, point.space, point.q, records, {})[1]


def _sensitivities(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    known: Mapping[str, np.ndarray],
) -> tuple[np.ndarray, np.ndarray, bool]:  # fmt: skip
    """ŷ at q (N, ny), J (N, ny, p) of which some columns may be known, `Point.by_equations`.

    Where many columns are asked, they come from the sensitivity equations, and else from
    simulations. Either way, one column along all of them at once says whether the two agree here.
    They do not where a joint hits its limit.
    """
    asked = np.array([name not in known for name in space.names])
    J = np.empty((*predictor.log.outputs.shape, len(q)))
    for j in np.flatnonzero(~asked):
        J[..., j] = known[space.names[j]]
    moves = np.diag(np.where(q + STEP > space.upper, -STEP, STEP))[asked]
    solves = bool(asked.any()) and can_solve(predictor, records)
    if solves and len(moves) > MANY:
        short = SHORTER * moves
        S = _solve(predictor, space, q, records, short, short.sum(axis=1))
        to = space.inside(q + STEP * _along(S, asked))
        predicted, ahead = predictor.predict(space.decode(np.vstack([q, to])))
        if _agree(S @ (to - q)[asked], ahead - predicted):
            J[..., asked] = S
            return predicted, J, True
        solves = False
    runs = predictor.predict(space.decode(np.vstack([q, q + moves])))
    moved = (runs[1:] - runs[0]) / moves.sum(axis=1)[:, None, None]
    J[..., asked] = np.moveaxis(moved, 0, -1)
    if solves:
        to = space.inside(q + SHORTER * STEP * _along(J[..., asked], asked))
        step = np.array([SHORTER * STEP])
        solved = _solve(predictor, space, q, records, (to - q)[None], step)[..., 0]
        solves = _agree(solved * step, J @ (to - q))
    return runs[0], J, solves


def _solve(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    moves: np.ndarray, size: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Columns of the sensitivity equations for m moves of q (m, p) of some sizes, (N, ny, m)."""
    there = space.decode(q + moves)
    return solve_sensitivities(predictor, records, space.decode(q), there, size)


def _along(columns: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """A direction of q of length 1 at most in each, to which all columns add alike, shape (p,)."""
    size = np.sqrt(np.mean(columns**2, axis=(0, 1)))
    signs = np.random.default_rng(0).choice([-1.0, 1.0], len(size))
    weight = np.where(size > 0, signs / np.where(size > 0, size, 1.0), 0.0)
    out = np.zeros(len(asked))
    out[asked] = weight / np.abs(weight).max(initial=1e-300)
    return out


def _agree(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two changes of the outputs are the same to `WRONG`."""
    return bool(np.linalg.norm(one - other) <= WRONG * np.linalg.norm(other))


def extend_point(point: Point, whole: Log) -> Point:
    """The same point on a longer log, of which its own log is a part; without J."""
    predictor = replace(point.predictor, log=whole)
    values = point.space.decode(point.q)
    e = whole.outputs - predictor.predict(values)[0]
    linear = linearise(predictor, values)
    return Point(
        predictor=predictor, space=point.space, q=point.q, e=e, J=point.J[:0], linear=linear
    )
