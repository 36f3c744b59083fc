"""Several effects that unseen records prove together, where none of them is proven alone.

What one effect does hides what another one does: of three that are missing, each alone may explain
too little to be told from chance, and the first that is accepted may stand for a part of each.

chosen    by what they explain of fitted windows together, and again about the refitted model, until
          the set stays the same: far from the truth a linear choice errs, and most of laws with
          states of joints, which are left out    (`identification.prediction.selection.set_choice`)
in place  each is the best of what was refitted in its place, beside the others
proven    each beside the others, and all together; the weakest that is not is left out
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.moves import Watch
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import refitted, weighed, with_effect
from identification.prediction.judging.trial import compared, find_doubt
from identification.prediction.scoring.contenders import list_starts
from identification.prediction.scoring.first_fit import begin
from identification.prediction.scoring.scores import window_scores
from identification.prediction.scoring.screening import score_all
from identification.prediction.selection.set_choice import choose, find_members
from identification.prediction.selection.set_members import (
    Key,
    Place,
    each_at_its_best,
    with_rivals,
)
from identification.prediction.selection.set_proof import proven_members
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.remaining import is_much_left
from identification.runtime.progress import Progress

MAX_CHOICES = 3  # of a set, each about the model with the one before
MAX_ROUNDS = 2  # of a choice, and of asking each of its members in its place


def add_set(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with several effects more, or as it is where none are proven together.

    Where a set predicts worse, what is left when its unproven members are out takes its place.

    Args:
        state: the state before.
        progress: is told each set, and what is refitted in the places of its members.
    """
    task, watch = state.task, Watch(state.seconds)
    if state.room < 2 or not state.scores or not is_much_left(state.model, task.options):
        return state
    model, places, refits, asked = state.model, dict[Key, Place](), 0, list[set[Key]]()
    for _ in range(MAX_ROUNDS):
        chosen = _with_set(state, model, progress)
        if _keys(chosen) in asked:
            break
        asked.append(_keys(chosen))
        proven = proven_members(state, chosen, refits, progress)
        if not proven:
            break
        if _is_worse(chosen, state.model, task.options):  # a member that is wrong spoils it
            chosen = proven[0].model
        model, places = each_at_its_best(state, chosen, progress)
        refits += sum(len(p.tried) for p in places.values())
        if _keys(model) in asked:
            break
        asked.append(_keys(model))
    found = proven_members(state, model, refits, progress) if places else ()
    watch.stop("refits")
    if not found:
        return replace(state, seconds=watch.seconds)
    model = weighed(found[0].model, task.horizon, task.confirm, task.options)
    scores = score_all(model, task.effects, task.options)
    watch.stop("scores")
    named = {c.candidate.key for c in found}
    new = tuple(with_rivals(c, places.get(c.candidate.key), named, scores) for c in found)
    return replace(
        state, model=model, accepted=(*state.accepted, *new), scores=scores, rejected=(),
        seconds=watch.seconds, exchanged=None,
    )  # fmt: skip


def _is_worse(chosen: WindowModel, present: WindowModel, options: DiscoveryOptions) -> bool:
    """Returns whether a set predicts worse than the present model, beyond chance if that has any.

    A curve has more numbers than the laws that it draws, and may predict a little better by luck.
    """
    if present.candidates:
        seen = compared(chosen.unseen, present.unseen, options)
        return find_doubt(seen, 1, options) is None
    return not compared(present.unseen, chosen.unseen, options).t > 0


def _keys(model: WindowModel) -> set[Key]:
    return {c.key for c in model.candidates}


def _with_set(state: WindowSearch, model: WindowModel, progress: Progress) -> WindowModel:
    """Returns the model refitted with the set that is chosen about itself.

    Args:
        state: without the set.
        model: where the choice begins.
        progress: is told each set.
    """
    task, best = state.task, model
    for _ in range(MAX_CHOICES):
        members = find_members(model, state.model)
        is_plain = uses(task.options, "plain_sets")
        scores = [s for s in state.scores if not (is_plain and s.candidate.effect.state)]
        chosen = choose(model, members, scores, task.options, state.room)
        keys = {c.key for c in chosen}
        if keys == {c.key for c in members} or len(keys) < 2:
            break
        progress("tried together: " + " + ".join(f"{c.effect.name}, {c.where}" for c in chosen))
        out = {c.key for c in members} - keys
        if out:
            kept = [c for c in model.candidates if c.key not in out]
            less = refitted(model, kept, task.nominal_model, task.confirm)
            if less is None:
                break
            model = less
        has = {c.key for c in model.candidates}
        for c in chosen:
            if c.key not in has:
                model = with_one(state, model, c) or model
        is_first = not find_members(best, state.model)
        best = model if is_first or _bic(model) < _bic(best) else best
    return best


def _bic(model: WindowModel) -> float:
    """Returns BIC of a fit, of which a smaller value is better: N ln V + p ln N."""
    fit = model.fit
    samples = sum(p.cut.outputs.size for p in fit.problem.parts)
    return float(samples * np.log(model.fitted_power) + len(fit.q) * np.log(samples))


def with_one(state: WindowSearch, model: WindowModel, candidate: Candidate) -> WindowModel | None:
    """Returns the model refitted with one effect more; None where it explains nothing.

    Args:
        state: whose data are fitted.
        model: without the effect.
        candidate: the effect at its place.
    """

    def evaluate() -> WindowModel | None:
        scores = window_scores(model.fit, [candidate])
        starts = [s for one in scores for s in (one, *list_starts(one, scores))]
        begun = begin(model, starts, uses(state.task.options, "loud_windows"))
        return with_effect(model, begun, state.task.horizon, state.task.confirm)

    return attempt(candidate, evaluate)
