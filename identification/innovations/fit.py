"""The fit of the nominal model together with some effects, along a free run."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from math import isclose

import numpy as np

from identification.discovery.fitted import BOUND_TOLERANCE
from identification.discovery.nominal_model import SHAPE_STD, NominalModel, nonzero
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.estimation.priors import Priors
from identification.kalman.noise_fit import START_CORRELATION_TIME
from identification.kalman.point import Point, evaluate_point
from identification.kalman.refit import Refit, refit
from identification.logs.log import Log
from identification.model.coordinates import Coordinates, coordinates
from identification.model.parameter import Parameter, ParameterSet
from identification.model.predictor import Predictor
from identification.runtime.progress import Progress

MAX_FIT_STEPS = 20  # of a fit


def fit_with_effects(
    nominal_model: NominalModel,
    log: Log,
    candidates: Sequence[Candidate],
    start: Mapping[str, float],
    options: DiscoveryOptions,
    steps: int = MAX_FIT_STEPS,
    near: Refit | None = None,
    progress: Progress | None = None,
    least: float = -np.inf,
) -> Refit:
    """Fit the nominal model's parameters together with the sizes and free shapes of some effects.

    Args:
        nominal_model: the model without effects.
        log: the samples to fit.
        candidates: the effects.
        start: values to begin at by name; the plant's own where not given.
        options: which noise and which parameters are believed.
        steps: largest number of steps.
        near: a fit whose noise, and columns of small parameters, are good enough to begin with.
        progress: is told one line per step.
        least: log posterior that the fit must come to, to matter; one that does not ends early.

    Raises:
        DivergenceError: the start cannot be simulated.
    """
    parameters = nominal_model.plant.parameters
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
    names = (*nominal_model.names, *sizes, *shapes)
    own = {**parameters.values(), **{n: v for c in candidates for n, v in c.fixed.items()}}
    begin = {**own, **start, **{n: nonzero(parameters[n], {**own, **start}[n]) for n in sizes}}
    first = np.array([_inside(parameters[n], begin[n]) for n in names])
    space = coordinates(parameters, names, first, linear=(*sizes, *nominal_model.linear))
    space = _within_factor(space, parameters, nominal_model.names, options.nominal_factor)
    if nominal_model.is_bounded:
        space = _within_scatter(space, nominal_model, options.max_scatter)
    space = _within_held(space, nominal_model.held)
    # A size has no prior, so that the mean of its prior is never used.
    known = {*nominal_model.names, *shapes}
    middle = {**own, **nominal_model.mean}
    mean = space.encode(np.where([n in known for n in names], [middle[n] for n in names], first))
    of_shapes = np.full(len(shapes), 1 / SHAPE_STD)
    weight = np.concatenate([1 / nominal_model.prior_std, np.zeros(len(sizes)), of_shapes])
    priors = Priors(space, mean, weight)
    level, beside = (None, None) if near is None else (near.level, near.point)
    predictor = Predictor(nominal_model.plant, log, names, fixed)
    small = frozenset(nominal_model.grouped)
    point = _same_point(predictor, space, space.encode(first), beside)
    if point is None:
        point = evaluate_point(predictor, space, space.encode(first), beside, small)
    if level is not None:
        # The correlation time that was found without the effect may have been the effect's own.
        level = replace(level, noise=level.noise.lasting(START_CORRELATION_TIME))
    is_near = near is not None and near.point.space.names == names
    found = refit(point, priors, options, steps, level, progress, is_near, least)
    if near is None or not _is_less_likely(found, near) or nominal_model.is_bounded:
        return found
    # A model is at least as likely as the one that it contains: the search, which believes no large
    # errors of the inputs at first, went another way.
    again = refit(point, priors, options, steps, near.level, progress, True, least)
    return max(found, again, key=lambda fit: fit.log_posterior)


def _same_point(
    predictor: Predictor, space: Coordinates, q: np.ndarray, near: Point | None
) -> Point | None:
    """Returns a point that is known, where it is the one at which a fit begins; else None.

    A fit under other priors begins where the one before it ended.
    """
    if near is None or near.space.names != space.names:
        return None
    known, log = near.predictor, predictor.log
    is_same = known.plant is predictor.plant and known.log.begun == log.begun
    is_same = is_same and np.array_equal(known.log.outputs, log.outputs)
    is_same = is_same and np.array_equal(known.log.inputs, log.inputs)
    is_same = is_same and known.fixed == predictor.fixed
    is_same = is_same and np.array_equal(near.space.logarithmic, space.logarithmic)
    is_same = is_same and np.array_equal(near.space.scale, space.scale)
    if not is_same or not np.allclose(near.space.decode(near.q), space.decode(q), rtol=1e-9):
        return None
    return replace(near, predictor=predictor, space=space, q=space.inside(q))


def _is_less_likely(found: Refit, near: Refit) -> bool:
    """Returns whether a fit is less likely than one with fewer parameters and the same priors."""
    prior = dict(zip(found.point.space.names, found.priors.weight, strict=True))
    fewer = dict(zip(near.point.space.names, near.priors.weight, strict=True))
    contained = len(fewer) < len(prior) and all(prior.get(n) == s for n, s in fewer.items())
    return contained and found.log_posterior < near.log_posterior


def _within_factor(
    space: Coordinates, parameters: ParameterSet, names: Sequence[str], factor: float
) -> Coordinates:
    """Returns coordinates in which the positive parameters among `names` stay within a factor."""
    nominal = np.array([parameters[n].value if n in names else 1.0 for n in space.names])
    bounded = space.logarithmic & np.isin(space.names, names)
    middle = np.log(np.where(bounded, nominal, 1.0))
    return replace(
        space,
        lower=np.where(bounded, np.maximum(space.lower, middle - np.log(factor)), space.lower),
        upper=np.where(bounded, np.minimum(space.upper, middle + np.log(factor)), space.upper),
    )


def _within_scatter(space: Coordinates, nominal: NominalModel, most: float) -> Coordinates:
    """Returns coordinates in which members of groups stay within `most` std of their mean, zero."""
    std = dict(zip(nominal.names, nominal.std, strict=True))
    grouped = nominal.grouped
    far = np.array([most * std[n] if n in grouped else np.inf for n in space.names])
    return replace(
        space, lower=np.maximum(space.lower, -far), upper=np.minimum(space.upper, far)
    )  # fmt: skip


def _within_held(space: Coordinates, held: Mapping[str, tuple[float, float]]) -> Coordinates:
    """Returns coordinates in which some parameters stay within ranges of their own."""
    everywhere = -np.inf, np.inf
    low, high = np.array([held.get(name, everywhere) for name in space.names]).T
    mine = np.isin(space.names, [*held])
    low, high = (np.where(mine, space.encode(np.where(mine, x, 1.0)), x) for x in (low, high))
    return replace(space, lower=np.maximum(space.lower, low), upper=np.minimum(space.upper, high))


def _inside(record: Parameter, value: float) -> float:
    """Returns the value moved a little inside its bounds."""
    margin = 1e-9 * max(abs(value), record.scale)
    return float(np.clip(value, record.lower + margin, record.upper - margin))


def list_at_bound(fit: Refit, names: Collection[str]) -> list[str]:
    """Returns those of some parameters that lie on a bound of their range.

    A search may keep a value within a narrower range of what is plausible; such a limit is told by
    a finding (`identification.innovations.findings`).

    Args:
        fit: a fit.
        names: of the parameters that are asked for.
    """
    parameters = fit.plant.parameters
    each = ((parameters[n], value) for n, value in fit.values.items() if n in names)
    return [
        p.name for p, value in each
        if any(isclose(value, b, rel_tol=BOUND_TOLERANCE) for b in (p.lower, p.upper) if b)
    ]  # fmt: skip
