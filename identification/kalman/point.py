"""A plant at one set of values: residual, sensitivities and linearisation along the trajectory.

e = y - ŷ(q),   Φ = ∂ŷ/∂q,   δx_{k+1} = A_k δx_k + B_k δu_k
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from identification.kalman.linear import LinearPlant, linearise
from identification.logs.log import Log
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor

STEP = 1e-4  # of q, for forward differences


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
    """

    predictor: Predictor
    space: Coordinates
    q: np.ndarray
    e: np.ndarray
    J: np.ndarray
    linear: LinearPlant
    small: frozenset[str] = frozenset()

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
    predictor: Predictor, space: Coordinates, q: np.ndarray, linear: LinearPlant | None = None,
    near: Point | None = None, small: frozenset[str] = frozenset(),
) -> Point:  # fmt: skip
    """Simulate a plant and its sensitivities at q, in one batch of simulations.

    Args:
        predictor: plant, log and free parameters.
        space: coordinates of the free parameters.
        q: shape (p,).
        linear: a linearisation from a point nearby that is good enough; a new one when None.
        near: a point nearby on the same log, from which columns of small parameters are taken.
        small: see `Point`.

    Raises:
        DivergenceError: a simulation left the finite numbers.
    """
    inside = space.inside(q)
    predicted, J = _sensitivities(predictor, space, inside, _known(near, small))
    if linear is None:
        linear = linearise(predictor, space.decode(inside))
    e = predictor.log.outputs - predicted
    return Point(predictor=predictor, space=space, q=inside, e=e, J=J, linear=linear, small=small)


def _known(near: Point | None, small: frozenset[str]) -> dict[str, np.ndarray]:
    """Columns of J that hold at a point nearby, by name, each (N, ny)."""
    if near is None:
        return {}
    columns = zip(near.space.names, np.moveaxis(near.J, 2, 0), strict=True)
    return {name: column for name, column in columns if name in small}


def evaluate_sensitivities(point: Point, whole: Log) -> np.ndarray:
    """J of the same point on a longer log, shape (N, ny, p)."""
    return _sensitivities(replace(point.predictor, log=whole), point.space, point.q)[1]


def _sensitivities(
    predictor: Predictor, space: Coordinates, q: np.ndarray,
    known: Mapping[str, np.ndarray] | None = None,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """ŷ at q, shape (N, ny), and J, shape (N, ny, p), of which some columns may be known."""
    known = known or {}
    asked = np.array([name not in known for name in space.names])
    moves = np.where(q + STEP > space.upper, -STEP, STEP)
    predicted = predictor.predict(space.decode(np.vstack([q, q + np.diag(moves)[asked]])))
    J = np.empty((*predicted[0].shape, len(q)))
    J[..., asked] = np.moveaxis((predicted[1:] - predicted[0]) / moves[asked, None, None], 0, -1)
    for j in np.flatnonzero(~asked):
        J[..., j] = known[space.names[j]]
    return predicted[0], J


def extend_point(point: Point, whole: Log) -> Point:
    """The same point on a longer log, of which its own log is a part; without J."""
    predictor = replace(point.predictor, log=whole)
    values = point.space.decode(point.q)
    e = whole.outputs - predictor.predict(values)[0]
    linear = linearise(predictor, values)
    return Point(
        predictor=predictor, space=point.space, q=point.q, e=e, J=point.J[:0], linear=linear
    )
