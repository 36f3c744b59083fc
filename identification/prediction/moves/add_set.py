"""Several effects that unseen records prove together, where none of them is proven alone.

What one effect does hides what another one does: of three that are missing, each alone may explain
too little to be told from chance, and the first that is accepted may stand for a part of each.

chosen    by what they explain of fitted windows together, and again about the refitted model, until
          the set stays the same: far from the truth a linear choice errs
                                                        (`identification.prediction.set_choice`)
in place  each is the best of what was refitted in its place, beside the others
proven    each beside the others, and all together; the weakest that is not is left out
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.moves import Watch
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.contenders import count_numbers, list_starts
from identification.prediction.crossing import at_all_lengths, at_their_best
from identification.prediction.evidence import all_gains, count_windows, evidence
from identification.prediction.exchange import exchanged, is_contradicted
from identification.prediction.extension import refitted, with_effect, with_fitting_steps
from identification.prediction.first_fit import begin
from identification.prediction.model import WindowModel
from identification.prediction.remaining import is_much_left
from identification.prediction.scores import WindowScore, window_scores
from identification.prediction.screening import score_all
from identification.prediction.selection import judged, refit_contenders
from identification.prediction.set_choice import choose, find_members
from identification.prediction.task import WindowSearch
from identification.prediction.trial import Contender, find_doubt, find_rivals
from identification.progress import Progress
from identification.windows.comparison import compare

MAX_CHOICES = 3  # of a set, each about the model with the one before
MAX_ROUNDS = 2  # of a choice, and of asking each of its members in its place

Key = tuple[str, str]


@dataclass(frozen=True)
class Place:
    """What was refitted in the place of a member of a set, beside the others."""

    without: WindowModel  # the model without the member
    scores: tuple[WindowScore, ...]  # on it
    tried: tuple[Contender, ...]  # what was refitted


def add_set(
    state: WindowSearch, progress: Progress, present: WindowModel | None = None
) -> WindowSearch:
    """Returns the state with several effects more, or as it is where none are proven together.

    Args:
        state: the state before.
        progress: is told each set, and what is refitted in the places of its members.
        present: the model that the set has to predict better than, on average over the blocks that
            decide, before its members are asked in their places, which takes most of the time; that
            of the state when None.
    """
    task, watch = state.task, Watch(state.seconds)
    if state.room < 2 or not state.scores or not is_much_left(state.model, task.options):
        return state
    model, places, refits, asked = state.model, dict[Key, Place](), 0, list[set[Key]]()
    for _ in range(MAX_ROUNDS):
        chosen = _with_set(state, model, progress)
        is_worse = not compare((present or state.model).unseen, chosen.unseen).t > 0
        if is_worse or _keys(chosen) in asked:
            break
        asked.append(_keys(chosen))
        model, places = _each_at_its_best(state, chosen, progress)
        refits += sum(len(p.tried) for p in places.values())
        if _keys(model) in asked:
            break
        asked.append(_keys(model))
    found = _proven(state, model, refits, progress)
    watch.stop("refits")
    if not found:
        return replace(state, seconds=watch.seconds)
    model = found[0].model
    scores = score_all(model, task.effects, task.options)
    watch.stop("scores")
    named = {c.candidate.key for c in found}
    new = tuple(_with_rivals(c, places.get(c.candidate.key), named, scores) for c in found)
    return replace(
        state, model=model, accepted=(*state.accepted, *new), scores=scores, rejected=(),
        seconds=watch.seconds, exchanged=None,
    )  # fmt: skip


def set_for_effects(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with a set in the place of all its effects, where more speaks for the set.

    It is asked where much is left, and where a curve stands beside other effects: the curve may be
    what several laws do together, of which it hides each. A set that was found in this way is not
    asked for again.
    """
    is_done = any(name == set_for_effects.__name__ for name in state.made)
    if is_done or not state.accepted or state.worse_fit is not None:
        return state
    is_asked = _has_curve_beside_others(state) or is_much_left(state.model, state.task.options)
    if not is_asked:
        return state
    bare = replace(
        state, model=state.nominal, accepted=(), scores=state.nominal_scores, exchanged=None
    )
    found = add_set(bare, progress, state.model)
    old, new = ({a.candidate.key for a in s.accepted} for s in (state, found))
    if not new or new <= old:
        return replace(state, seconds=found.seconds)
    numbers = [sum(a.numbers for a in s.accepted) for s in (state, found)]
    options = state.task.options
    gains = [all_gains(state.nominal, s.model, options) for s in (state, found)]
    windows, outputs = count_windows(state.nominal), len(state.nominal.scale)
    before, after = evidence(gains, numbers, windows, outputs)[:, 0]
    if not after > before:
        return replace(state, seconds=found.seconds)
    progress("together they explain more than the effects that were found one by one")
    lost = tuple(a for a in state.accepted if a.candidate.key not in new)
    return replace(found, rejected=(*lost, *state.rejected))


def _has_curve_beside_others(state: WindowSearch) -> bool:
    """Returns whether one of several effects is a curve."""
    return len(state.accepted) > 1 and any(a.candidate.effect.is_curve for a in state.accepted)


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
        chosen = choose(model, members, state.scores, task.options, state.room)
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
        is_loud = uses(state.task.options, "loud_windows")
        begun = begin(model, starts, is_loud)
        return with_effect(model, begun, state.task.horizon, state.task.confirm)

    return attempt(candidate, evaluate)


def _each_at_its_best(
    state: WindowSearch, model: WindowModel, progress: Progress
) -> tuple[WindowModel, dict[Key, Place]]:
    """Returns the model in which each member is the best in its place, and what was tried there."""
    task, options = state.task, state.task.options
    laws = [e for e in task.effects if not e.is_curve and not e.is_of_records]
    asked, places = [c.key for c in find_members(model, state.model)], dict[Key, Place]()
    for key in asked if len(asked) > 1 else ():
        rest = [c for c in model.candidates if c.key != key]
        parent = refitted(model, rest, task.nominal_model, task.confirm)
        if parent is None:
            continue
        scores = score_all(parent, laws, options)
        parent, tried = refit_contenders(
            parent, scores, task.horizon, task.confirm, options, progress
        )
        own = next((c for c in tried if c.candidate.key == key), None)
        best = max(tried, key=lambda c: c.criterion, default=None)
        least = own.criterion if own else _criterion(parent, model, key, options)
        if best is not None and best is not own and best.criterion > least:
            progress(f"{best.candidate.effect.name}, {best.candidate.where}: better in its place")
            model, key = best.model, best.candidate.key
        places[key] = Place(parent, scores, tried)
    return model, places


def _criterion(
    parent: WindowModel, model: WindowModel, key: Key, options: DiscoveryOptions
) -> float:
    """Returns E of one of a model's effects, beside the others."""
    numbers = next(count_numbers(c) for c in model.candidates if c.key == key)
    windows, outputs = count_windows(parent), len(parent.scale)
    return float(evidence([all_gains(parent, model, options)], [numbers], windows, outputs)[0, 0])


def _proven(
    state: WindowSearch, model: WindowModel, refits: int, progress: Progress
) -> tuple[Contender, ...]:
    """Returns the members that are proven, each beside the others; none where fewer than two are.

    Args:
        state: the model without them.
        model: with all of them, which may have predicted the horizon alone.
        refits: how many effects were refitted, which chance has to pay for.
        progress: is told what is left out.
    """
    task, options = state.task, state.task.options
    shorter = partial(with_fitting_steps, model, task.horizon, task.confirm)
    model = attempt(None, shorter) or model
    while True:
        new = [c.key for c in find_members(model, state.model)]
        if len(new) < 2:  # one alone was refused where it competed with curves
            return ()
        parent, (whole,) = at_all_lengths(
            state.model, [model], task.horizon, task.confirm, uses(options, "states_of_others")
        )
        each = [] if whole is None else [_beside(state, whole, key, refits) for key in new]
        if whole is None or None in each:
            return ()
        known = [c for c in each if c is not None]
        lost = [c for c in known if not c.is_proven]
        if not lost:
            break
        weakest = min(lost, key=lambda c: c.criterion).candidate
        progress(f"{weakest.effect.name}, {weakest.where}: not proven beside the others")
        rest = [c for c in model.candidates if c.key != weakest.key]
        less = refitted(model, rest, task.nominal_model, task.confirm)
        if less is None:
            return ()
        model = less
    seen = compare(parent.unseen, whole.unseen)
    is_proven = find_doubt(seen, max(1, refits), options) is None
    return tuple(known) if is_proven and not _is_contradicted(state, parent, whole) else ()


def _beside(state: WindowSearch, model: WindowModel, key: Key, refits: int) -> Contender | None:
    """Returns what an effect does beside the others; None where these cannot be refitted alone."""
    task = state.task
    rest = [c for c in model.candidates if c.key != key]
    mine = [c for c in model.candidates if c.key == key]
    without = refitted(model, rest, task.nominal_model, task.confirm)
    if without is None:
        return None
    best = replace(model, candidates=(*rest, *mine))
    if uses(task.options, "states_of_others"):
        without, (best,) = at_their_best(without, [best], task.horizon, task.confirm)
    return judged(without, best, max(1, refits), task.options)


def _is_contradicted(state: WindowSearch, parent: WindowModel, whole: WindowModel) -> bool:
    """Returns whether all of them predict worse with the roles of the records exchanged."""
    task = state.task
    if not uses(task.options, "exchange_roles"):
        return False
    without, with_it = (exchanged(m, task.records, task.horizon) for m in (parent, whole))
    if without is None or with_it is None:
        return False
    return is_contradicted(without, with_it, task.options)


def _with_rivals(
    member: Contender, place: Place | None, named: set[Key], scores: Sequence[WindowScore]
) -> Contender:
    """Returns a member with what was tried in its place and may be meant.

    A rival gains as much less than the member as it did when both were refitted in this place: the
    other members may have changed since.

    Args:
        member: of the set.
        place: what was tried there.
        named: what the set has.
        scores: on the model with all of it.
    """
    if place is None:
        return member
    own = next((o for o in place.tried if o.candidate.key == member.candidate.key), None)
    if own is None:
        return member
    others = [o for o in place.tried if o.candidate.key not in named]
    rivals = find_rivals(others, place.without, place.scores, member.model, scores)
    return replace(member, alternatives=tuple(
        replace(o, gains=member.gains + o.gains - own.gains) for o in rivals
    ))  # fmt: skip
