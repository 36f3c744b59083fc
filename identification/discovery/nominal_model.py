"""A model with some effects: its free parameters, and where their search begins."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.effects.effect import Candidate
from identification.kalman.noise_fit import TIME
from identification.kalman.point import evaluate_point
from identification.kalman.refit import Refit, refit
from identification.logs.log import Log
from identification.model.coordinates import Coordinates, coordinates
from identification.model.parameter import Parameter, ParameterSet
from identification.model.predictor import Plant, Predictor

SHAPE_STD = 1.0  # prior of a shape's logarithm about the grid value that scored best
FARTHEST = 3.0  # factor by which a base parameter may leave its nominal value
SMALL = 1e-3  # of a probe: where the search for a size begins that must not be zero


@dataclass(frozen=True)
class NominalModel:
    """The nominal model's free parameters and what is known of them.

    Attributes:
        plant: the model, all candidate effects included.
        names: its free parameters.
        std: prior std of each, relative where it is logarithmic, else in its unit, shape (p,).
        horizon: over which predictions are judged [s]; None for a free run of the whole log, which
            says little of a robot that integrates what disturbs it.
    """

    plant: Plant
    names: tuple[str, ...]
    std: np.ndarray
    horizon: float | None = None


def fit_with_effects(
    base: NominalModel,
    log: Log,
    candidates: Sequence[Candidate],
    start: Mapping[str, float],
    steps: int = 20,
    near: Refit | None = None,
) -> Refit:
    """Fit the model with some effects: base parameters, their sizes and their free shapes.

    Args:
        base: the nominal model.
        log: what to explain.
        candidates: the effects.
        start: values to begin at by name; the plant's own where not given.
        steps: at most as many.
        near: a fit whose linearisation and noise are good enough to begin with.

    Raises:
        DivergenceError: the start cannot be simulated.
    """
    parameters = base.plant.parameters
    sizes = [name for c in candidates for name in c.free]
    shapes = dict.fromkeys(
        c.effect.parameter(shape.name, c.where)
        for c in candidates
        for shape in c.effect.shapes
        if shape.free
    )
    fixed = {
        n: v for c in candidates for n, v in (*c.fixed.items(), *c.whole.items()) if n not in shapes
    }
    names = (*base.names, *sizes, *shapes)
    own = {**parameters.values(), **{n: v for c in candidates for n, v in c.fixed.items()}}
    begin = {**own, **start, **{n: _there(parameters[n], {**own, **start}[n]) for n in sizes}}
    first = np.array([_inside(parameters[n], begin[n]) for n in names])
    space = _plausible(coordinates(parameters, names, first, linear=sizes), parameters, base.names)
    known = {*base.names, *shapes}  # a size has no prior, and its mean no meaning
    mean = space.encode(np.where([n in known for n in names], [own[n] for n in names], first))
    weight = np.concatenate(
        [1 / base.std, np.zeros(len(sizes)), np.full(len(shapes), 1 / SHAPE_STD)]
    )
    linear, level = (None, None) if near is None else (near.point.linear, near.level)
    point = evaluate_point(
        Predictor(base.plant, log, names, fixed), space, space.encode(first), linear
    )
    if level is not None:  # what its inputs' error lasted may have been the effect
        level = replace(level, noise=level.noise.lasting(TIME))
    return refit(point, mean, weight, steps, level)


def _plausible(space: Coordinates, parameters: ParameterSet, names: Sequence[str]) -> Coordinates:
    """Coordinates whose base parameters stay within a factor of their nominal values.

    A wrong model would carry them anywhere, to imitate what it lacks.
    """
    nominal = np.array([parameters[n].value if n in names else 1.0 for n in space.names])
    bounded = space.logarithmic & np.isin(space.names, names)
    middle = np.log(np.where(bounded, nominal, 1.0))
    return replace(
        space,
        lower=np.where(bounded, np.maximum(space.lower, middle - np.log(FARTHEST)), space.lower),
        upper=np.where(bounded, np.minimum(space.upper, middle + np.log(FARTHEST)), space.upper),
    )


def _there(record: Parameter, value: float) -> float:
    """A size that is not zero."""
    least = SMALL * record.scale
    return value if abs(value) > least else least * (1 if record.upper > 0 else -1)


def _inside(record: Parameter, value: float) -> float:
    """A value a little inside its bounds."""
    margin = 1e-9 * max(abs(value), record.scale)
    return float(np.clip(value, record.lower + margin, record.upper - margin))
