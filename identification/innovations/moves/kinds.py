"""Once an effect is added, those before it may be of another kind than they seemed alone.

A torque constant that falls with time looks like one that falls with heat as long as something else
is missing. So every accepted effect is compared, to first order, with its other kinds and powers,
which are no free shapes; where one of them explains more it is refitted, and the likelier model is
kept. A free shape is chosen anew for each kind: a Stribeck peak of the power 2 is as wide as one of
the power 1 at another speed. Where the model leaves structure the wrong kind may have moved other
parameters far, and the first order is wrong by much: each kind is then refitted that explains
enough of what the effect does (`retry_share`). A limit (a current that is clipped, or that bends)
is far from linear in its shape: its other kinds are scored on the model without it, and the best of
each is refitted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

from identification.discovery.attempts import attempt
from identification.effects.effect import Candidate
from identification.innovations.fitted_model import (
    ROUGH_FIT_STEPS,
    AcceptedEffect,
    FittedModel,
    score_candidates,
    try_fit,
)
from identification.innovations.moves.shapes import BARE_BIC, is_structured
from identification.innovations.replacement import replace_effect
from identification.innovations.scoring.scores import Score
from identification.innovations.scoring.sensitivities import Sensitivity, compute_beside
from identification.innovations.scoring.significance import gain_of_whole, is_plausible
from identification.innovations.task import DiscoveryTask
from identification.kalman.point import Point


def improve_kinds(
    task: DiscoveryTask,
    accepted: Sequence[AcceptedEffect],
    model: FittedModel,
    sensitivities: Sequence[Sensitivity],
) -> tuple[tuple[AcceptedEffect, ...], FittedModel]:
    """Returns the accepted effects, each of the kind that is the likeliest beside the others.

    Args:
        task: the nominal model, the log and the options.
        accepted: the effects in the order in which they were added.
        model: the model with all of them.
        sensitivities: of all candidates.

    Returns:
        The effects, and the model with them.
    """
    kept = list(accepted)
    for i, old in enumerate(kept):
        mine = next(c for c in model.candidates if c.key == old.candidate.key)
        kinds = (
            _list_kinds(task, mine, model, _share(task, model))
            if mine.free
            else _list_limits(task, mine, model, sensitivities)
        )
        best, parent = mine, model
        for other, start in kinds:
            new = _fit_kind(task, other, start, parent)
            if new is not None and new.negative_bic > model.negative_bic:
                best, model = other, new
        if best is not mine:
            # Gain and rivals stay those of the round in which it was accepted.
            begun = replace(old.model, candidates=(*old.model.candidates[:-1], best))
            kept[i] = replace(old, model=begun)
    return tuple(kept), model


def improve_rivals(
    task: DiscoveryTask, best: FittedModel, others: Sequence[FittedModel]
) -> list[FittedModel]:
    """Returns refits of a round, each rival of its likeliest kind, the best refit first.

    A delay of all encoders is one of all inputs, and no lag. The first order says little about the
    trajectory of a wrong effect, so that each kind is refitted that explains enough. A rival comes
    first only where it is likelier than the best refit by more than is worth a bare mention.

    Args:
        task: the nominal model, the log and the options.
        best: the best refit; its effect is the last of its candidates, and of the likeliest kind.
        others: refits of other effects in its place, the most likely one first.
    """
    improved, share = [], task.options.retry_share
    for model in others:
        mine, rival = model.candidates[-1], model
        for other, start in _list_kinds(task, mine, model, share) if mine.free else []:
            new = _fit_kind(task, other, start, model)
            if new is not None and new.negative_bic > rival.negative_bic:
                rival = new
        improved.append(rival)

    def order(model: FittedModel) -> float:
        return model.negative_bic + (BARE_BIC if model is best else 0.0)

    return sorted([best, *improved], key=order, reverse=True)


def _fit_kind(
    task: DiscoveryTask, other: Candidate, start: Mapping[str, float], model: FittedModel
) -> FittedModel | None:
    """Returns a model with an effect of another kind, by a short search if no structure is left."""
    candidates = tuple(other if c.key == other.key else c for c in model.candidates)
    begin, least = {**model.refit.point.values, **start}, model.refit.log_posterior
    if is_structured(model, task.options):
        return try_fit(task, candidates, begin, tried=other)
    return try_fit(task, candidates, begin, model, least=least, tried=other)


def _share(task: DiscoveryTask, model: FittedModel) -> float:
    """Returns the share of an effect's gain that another kind may lose and is still refitted."""
    return task.options.retry_share if is_structured(model, task.options) else 0.0


def _list_kinds(
    task: DiscoveryTask, old: Candidate, model: FittedModel, share: float
) -> list[tuple[Candidate, dict[str, float]]]:
    """Returns an effect of each other kind that explains enough to be refitted, to first order.

    Args:
        task: the nominal model, the log and the options.
        old: the effect, one of the model's.
        model: the model with it.
        share: of its gain that another kind may lose and is refitted all the same.

    Returns:
        The effect of each such kind, and the values of its sizes and shapes to begin at.
    """
    best: dict[tuple[float, ...], tuple[float, Candidate, np.ndarray]] = {}
    kinds, fit = [s.name for s in old.effect.shapes if not s.free], model.refit
    for s in _beside(fit.point, _other_kinds(old, model)):
        other = attempt(s.candidate, partial(replace_effect, fit, old, s.S, fit.level))
        if other is None:
            continue
        kind = tuple(s.candidate.shape[name] for name in kinds)
        is_best = kind not in best or other.loss < best[kind][0]
        is_enough = other.share * (1 - share) < 1  # it loses less than this share of the gain
        if is_best and is_enough and is_plausible(s.candidate, other.size, task.options):
            best[kind] = other.loss, s.candidate, other.size
    return [
        (new, {**new.fixed, **dict(zip(new.sizes, size.tolist(), strict=True))})
        for _, new, size in best.values()
    ]


def _list_limits(
    task: DiscoveryTask, old: Candidate, model: FittedModel, sensitivities: Sequence[Sensitivity]
) -> list[tuple[Candidate, Mapping[str, float]]]:
    """Returns the best of each other kind of an effect, by its score on the model without it.

    Args:
        task: the nominal model, the log and the options.
        old: the effect, one of the model's.
        model: the model with it.
        sensitivities: of all candidates.

    Returns:
        The effect of another kind, and the values of its sizes and shapes to begin at.
    """
    kinds = [shape.name for shape in old.effect.shapes if not shape.free]
    same = [s for s in sensitivities if s.candidate.key == old.key]
    others = [s for s in same if any(s.candidate.shape[k] != old.shape[k] for k in kinds)]
    if not others:
        return []
    rest = tuple(c for c in model.candidates if c.key != old.key)
    without = try_fit(task, rest, model.refit.point.values, model, ROUGH_FIT_STEPS)
    best: dict[tuple[float, ...], Score] = {}
    scores = score_candidates(without, others, task.options) if without else ()
    for s in sorted(scores, key=gain_of_whole, reverse=True):
        best.setdefault(tuple(s.candidate.shape[k] for k in kinds), s)
    return [
        (s.candidate, {**s.candidate.fixed, **dict(zip(s.candidate.sizes, s.size, strict=True))})
        for s in best.values()
    ]


def _beside(point: Point, candidates: Sequence[Candidate]) -> list[Sensitivity]:
    """Returns sensitivities to an effect of other kinds; one that diverges is told and left out."""
    every = attempt(None, partial(compute_beside, point, candidates))
    if every is not None:
        return [*every]
    each = (attempt(c, partial(compute_beside, point, [c])) for c in candidates)
    return [s for found in each if found for s in found]


def _other_kinds(old: Candidate, model: FittedModel) -> list[Candidate]:
    """Returns an effect with every other combination of its fixed shapes.

    Its free shapes have their fitted values, or those of their grids.
    """
    values, shapes = model.refit.point.values, old.effect.shapes
    grids = [
        (values[old.effect.parameter(s.name, old.where)], *s.grid) if s.free else s.grid
        for s in shapes
    ]
    every = (dict(zip([s.name for s in shapes], each, strict=True)) for each in product(*grids))
    fixed = [s.name for s in shapes if not s.free]
    return [
        replace(old, shape=shape)
        for shape in every
        if any(shape[name] != old.shape[name] for name in fixed)
    ]
