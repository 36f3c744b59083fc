"""The effects of a finished search over a horizon as its result tells them.

A name has the values of the final model, its share of the odds among its rivals, and its proof on
data on which the search has decided and on data that it has not touched.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification.chances import mean_above_zero
from identification.discovery.effect_results import NamedEffect, Proof, RejectedEffect, Rival
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.odds import find_odds
from identification.prediction.judging.trial import Contender, Doubt
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.neighbours import explained_by, neighbour_of
from identification.prediction.verdict.yardstick import Yardstick
from identification.windows.comparison import Prediction

MIN_LISTED_CONFIDENCE = 0.02  # a rival that is less likely is not listed


def named_effect(
    state: WindowSearch, accepted: Contender, limit: float, stick: Yardstick | None
) -> NamedEffect:
    """Returns an accepted effect at the values of the final model, with its rivals.

    Args:
        state: the finished state.
        accepted: the effect.
        limit: the upper limit of the confidence.
        stick: what smooth forces would still explain; None where it is not known.
    """
    options, mine = state.task.options, accepted.candidate
    explained = explained_by(accepted, state.accepted, state.model)
    is_final = any(c.key == mine.key for c in state.model.candidates)
    final = state.model if is_final else accepted.model
    odds = find_odds(accepted, final)
    candidate, parameters = fitted_sizes(final, mine)
    own = min(limit, odds.own)
    twins = [o for o in accepted.alternatives if o.candidate.key == (odds.twin, mine.where)]
    return NamedEffect(
        candidate=candidate, parameters=parameters, confidence=own,
        rivals=tuple(
            _rival(o, share) for o, share in odds.rivals if share > MIN_LISTED_CONFIDENCE
        ),
        compared=odds.compared,
        one_of=bool(odds.likeliest and odds.likeliest[1] > options.set_confidence),
        evidence=accepted.criterion, proof=_proof(state, accepted),
        same_as=next((e for e in state.task.effects if e.name == odds.twin), None),
        twin=_rival(twins[0], own) if twins else None,
        smooth_share=stick.share_of(mine, explained.law, explained.curves) if stick else None,
        neighbour=accepted.neighbour or neighbour_of(accepted, state, stick),
    )  # fmt: skip


def _proof(state: WindowSearch, effect: Contender) -> Proof:
    """Returns what an effect does for the records that confirm: what decided, and what is told."""
    seen = effect.prediction
    told = None if seen.untouched is None else _proof_of(state, seen.untouched)
    return replace(_proof_of(state, seen), untouched=told)


def _proof_of(state: WindowSearch, seen: Prediction) -> Proof:
    names = [r.log.name for r in state.task.confirm]
    worse = [len(b) > 2 and mean_above_zero(-b)[1] < state.task.options.significance
             for b in seen.blocks]  # fmt: skip
    return Proof(
        test="Student's t", t=seen.t, chance=seen.chance, fall=seen.fall,
        blocks=sum(map(len, seen.blocks)), falls=seen.falls, records=seen.records,
        is_everywhere=seen.is_everywhere,
        agrees=tuple(n for n, g in zip(names, seen.records, strict=True) if g > 0),
        disagrees=tuple(n for n, is_worse in zip(names, worse, strict=True) if is_worse),
    )  # fmt: skip


def rejected_effect(state: WindowSearch, contender: Contender) -> RejectedEffect:
    """Returns an effect that was refitted and not accepted, at the values of its own model."""
    c = contender
    candidate, parameters = fitted_sizes(c.model, c.candidate)
    proof = _proof(state, c)
    return RejectedEffect(
        candidate, parameters, np.nan, proof, evidence=c.criterion, doubt=c.doubt, luck=c.luck
    )  # fmt: skip


def unnamed_effect(named: NamedEffect, doubt: Doubt | None) -> RejectedEffect:
    """Returns an effect that is told as tried, because its name is not sure."""
    n = named
    return RejectedEffect(
        n.candidate, n.parameters, np.nan, n.proof, evidence=n.evidence, confidence=n.confidence,
        doubt=doubt,
    )  # fmt: skip


def _rival(contender: Contender, confidence: float) -> Rival:
    """Returns another effect with the values of its law, at those of its own model."""
    candidate, parameters = fitted_sizes(contender.model, contender.candidate)
    every, own = contender.model.told_values, (*candidate.sizes, *candidate.fixed)
    values = {n: float(every[n]) for n in own if n in every}
    values = {**candidate.fixed, **candidate.whole, **values}
    return Rival(candidate, confidence, values=values, parameters=parameters)


def fitted_sizes(
    model: WindowModel, candidate: Candidate
) -> tuple[Candidate, dict[str, tuple[float, float, str]]]:
    """Returns an effect with its shape, and sizes and shapes by symbol: value, std, unit."""
    c, plant, unknowns = candidate, model.plant, model.fit.problem.unknowns
    values = model.told_values
    # A bound holds a value as it holds what is not estimated: neither has a std.
    std = {n: 0.0 if n in model.at_bound else s for n, s in model.told_std.items()}
    parameters = {}
    symbols = [plant.parameters[n].symbol for n in (*c.sizes, *c.fixed)]
    for name in (*c.sizes, *c.fixed):
        record = plant.parameters[name]
        is_one = record.symbol and symbols.count(record.symbol) == 1
        said = record.symbol if is_one else record.name.partition(".")[2] or record.name
        if name in unknowns.own.names:
            each = {f"{said} [{r}]": f"{name} [{r}]" for r in unknowns.records}
        else:
            each = {said: name}
        for word, full in each.items():
            parameters[word] = (float(values[full]), float(std.get(full, 0.0)), record.unit)
        if name in unknowns.own.names:
            for r, own in model.unseen.own.items():
                parameters[f"{said} [{r}]"] = (*own[name], record.unit)
    shape = {s.name: values[c.effect.parameter(s.name, c.where)] for s in c.effect.shapes}
    return replace(c, shape=shape), parameters
