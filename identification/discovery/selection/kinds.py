"""Once an effect is added, those before it may be of another kind than they seemed alone.

A torque constant that falls with time looks like one that falls with heat as long as something else
is missing. So every accepted effect is compared, to first order, with its other kinds and powers,
which are no free shapes; where one of them explains more it is refitted, and the likelier model is
kept. A limit (a current that is clipped, or that bends) is far from linear in its shape: its other
kinds are scored on the model without it, and the best of each is refitted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product

from identification.discovery.fitted_model import (
    FEW,
    AcceptedEffect,
    FittedModel,
    score_candidates,
    try_fit,
)
from identification.discovery.replacement import replace_effect
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.sensitivities import Sensitivity, compute_beside
from identification.discovery.scoring.significance import gain_of_whole, is_plausible
from identification.discovery.task import DiscoveryTask
from identification.effects.effect import Candidate


def improve_kinds(
    task: DiscoveryTask,
    accepted: Sequence[AcceptedEffect],
    model: FittedModel,
    sensitivities: Sequence[Sensitivity],
) -> tuple[tuple[AcceptedEffect, ...], FittedModel]:
    """The accepted effects, each of the kind that is the likeliest beside the others.

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
            _list_kinds(task, mine, model)
            if mine.free
            else _list_limits(task, mine, model, sensitivities)
        )
        for other, start in kinds:
            candidates = tuple(other if c.key == other.key else c for c in model.candidates)
            begin, least = {**model.refit.point.values, **start}, model.refit.log_posterior
            new = try_fit(task, candidates, begin, model, least=least)
            if new is not None and new.negative_bic > model.negative_bic:
                # Gain and rivals stay those of the round in which it was accepted.
                begun = replace(old.model, candidates=(*old.model.candidates[:-1], other))
                kept[i], model = replace(old, model=begun), new
    return tuple(kept), model


def _list_kinds(
    task: DiscoveryTask, old: Candidate, model: FittedModel
) -> list[tuple[Candidate, dict[str, float]]]:
    """An effect of each other kind that explains more, to first order, with its sizes."""
    out, fit = [], model.refit
    for s in compute_beside(fit.point, _other_kinds(old, model)):
        other = replace_effect(fit, old, s.S, fit.level)
        if other.loss < 0 and is_plausible(s.candidate, other.size, task.options):
            out.append((s.candidate, dict(zip(old.sizes, other.size.tolist(), strict=True))))
    return out


def _list_limits(
    task: DiscoveryTask, old: Candidate, model: FittedModel, sensitivities: Sequence[Sensitivity]
) -> list[tuple[Candidate, Mapping[str, float]]]:
    """The best of each other kind of an effect, by its score on the model without the effect.

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
    without = try_fit(task, rest, model.refit.point.values, model, FEW)
    best: dict[tuple[float, ...], Score] = {}
    scores = score_candidates(without, others, task.options) if without else ()
    for s in sorted(scores, key=gain_of_whole, reverse=True):
        best.setdefault(tuple(s.candidate.shape[k] for k in kinds), s)
    return [
        (s.candidate, {**s.candidate.fixed, **dict(zip(s.candidate.sizes, s.size, strict=True))})
        for s in best.values()
    ]


def _other_kinds(old: Candidate, model: FittedModel) -> list[Candidate]:
    """An effect with every other combination of its fixed shapes, and its fitted free ones."""
    values, shapes = model.refit.point.values, old.effect.shapes
    free = {s.name: values[old.effect.parameter(s.name, old.where)] for s in shapes if s.free}
    fixed = [s for s in shapes if not s.free]
    names = [s.name for s in fixed]
    every = [dict(zip(names, each, strict=True)) for each in product(*(s.grid for s in fixed))]
    return [
        replace(old, shape={**free, **kind})
        for kind in every
        if any(kind[name] != old.shape[name] for name in names)
    ]
