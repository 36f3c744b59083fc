"""Pruning: once several effects are accepted, is each still needed, and still the right one?

Backward elimination drops an effect when the model without it has the better BIC. Exchange replaces
an effect by one that was refitted in its place, or that scores as well beside the other effects,
when the model with that one has the better BIC.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.effects.effect import Candidate
from identification.innovations.fitted_model import (
    NEEDED_BIC_RATIO,
    ROUGH_FIT_STEPS,
    AcceptedEffect,
    FittedModel,
    is_confirmed,
    score_candidates,
    try_fit,
)
from identification.innovations.proof import prove
from identification.innovations.replacement import retune
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.innovations.scoring.significance import select_plausible
from identification.innovations.task import DiscoveryTask


def without_needless(
    task: DiscoveryTask, model: FittedModel, old: AcceptedEffect
) -> FittedModel | None:
    """Returns the model without an effect where its BIC is the better one; else None."""
    if _is_needed(task, model, old.candidate):
        return None
    rest = tuple(c for c in model.candidates if c is not old.candidate)
    least = model.log_posterior_of_equal(_count(model, old.candidate))
    without = try_fit(task, rest, model.refit.point.values, model, least=least)
    if without is None or without.negative_bic <= model.negative_bic:
        return None
    return without


def _is_needed(task: DiscoveryTask, model: FittedModel, candidate: Candidate) -> bool:
    """Returns whether the model would be far less likely without an effect, with all re-tuned.

    To first order: `NEEDED_BIC_RATIO` times what BIC asks leaves room for what is not linear. Of a
    limit, whose size is not estimated, this says nothing.
    """
    retuned = attempt(None, partial(retune, model.refit, task.nominal_model, candidate))
    loss = retuned[0] if retuned else np.inf
    asked = len(candidate.free) * np.log(len(model.refit.point.log))
    return bool(np.isfinite(loss) and loss > NEEDED_BIC_RATIO * asked)


def exchange(
    task: DiscoveryTask,
    nominal: FittedModel,
    accepted: Sequence[AcceptedEffect],
    model: FittedModel,
    sensitivities: Sequence[Sensitivity],
) -> tuple[tuple[AcceptedEffect, ...], FittedModel]:
    """Try the rivals of each of several effects in its place; a single effect is left as it is."""
    kept = list(accepted)
    for i, old in enumerate(kept if len(kept) > 1 else ()):
        rest = tuple(c for c in model.candidates if c is not old.candidate)
        rivals = [*_list_rivals(task, old, rest, model, sensitivities)]
        for rival, start in rivals:
            if any(rival.effect.name == c.effect.name for c in rest):
                continue
            begin = {**model.refit.point.values, **start}
            margin = task.options.retry_share * old.gain
            least = model.log_posterior_of_equal(_count(model, old.candidate, rival))
            new = _fit_rival(task, (*rest, rival), begin, model, margin, least)
            if new is None:
                continue
            proof = prove(nominal.validation, new.validation, task.options)
            is_likelier = new.negative_bic > model.negative_bic
            if is_likelier and is_confirmed(proof, task.options, len(rivals)):
                alternatives = (replace(model, candidates=(*rest, old.candidate)),)
                gain = old.gain + new.negative_bic - model.negative_bic
                kept[i] = AcceptedEffect(new, old.proof, gain, alternatives)
                model = new
                break
    return tuple(kept), model


def _fit_rival(
    task: DiscoveryTask,
    candidates: tuple[Candidate, ...],
    begin: Mapping[str, float],
    model: FittedModel,
    margin: float,
    least: float,
) -> FittedModel | None:
    """Returns a model with a rival; None where few steps show that it is not likely enough.

    Its BIC is then behind by more than a margin, or its fit has ended below the log posterior
    `least`.
    """
    rival = candidates[-1]
    new = try_fit(task, candidates, begin, model, ROUGH_FIT_STEPS, least, rival)
    if new is None or new.negative_bic < model.negative_bic - margin:
        return None
    if new.refit.steps < ROUGH_FIT_STEPS and new.refit.log_posterior < least:
        return None
    return try_fit(task, candidates, new.refit.point.values, new, least=least, tried=rival)


def _count(model: FittedModel, without: Candidate, with_it: Candidate | None = None) -> int:
    """Returns the count of free parameters without an effect, or with another one in its place."""
    names = {*model.refit.point.space.names} - {*without.estimated}
    return len(names | {*(() if with_it is None else with_it.estimated)})


def _list_rivals(
    task: DiscoveryTask,
    old: AcceptedEffect,
    rest: tuple[Candidate, ...],
    model: FittedModel,
    sensitivities: Sequence[Sensitivity],
) -> list[tuple[Candidate, Mapping[str, float]]]:
    """Returns candidates that may stand in an effect's place, each with values to begin at.

    They need not be beyond chance, only as good as the effect itself: a refit and its proof decide.
    """
    options = task.options
    out: dict[tuple[str, str], tuple[Candidate, Mapping[str, float]]] = {
        _key(m.candidates[-1]): (m.candidates[-1], m.refit.point.values)
        for m in old.alternatives
        if old.model.negative_bic - m.negative_bic <= options.retry_share * old.gain
    }
    without = try_fit(task, rest, model.refit.point.values, model, ROUGH_FIT_STEPS)
    scores = []
    if without is not None:
        scores = select_plausible(score_candidates(without, sensitivities, options), options)
    mine = _key(old.candidate)
    own = next((s.gain for s in scores if _key(s.candidate) == mine), 0.0)
    for s in scores:
        if s.gain > options.equal_share * own and _key(s.candidate) != mine:
            sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
            out.setdefault(_key(s.candidate), (s.candidate, sizes))
    return list(out.values())[: options.max_refits]


def _key(candidate: Candidate) -> tuple[str, str]:
    return candidate.effect.name, candidate.where
