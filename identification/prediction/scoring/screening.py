"""Scores of all that a model lacks: everything on some windows, what is promising on all of them.

A score of one place is worth as much as one of all places, and a shape that is best for all places
together may be wrong for each of them. So every shape is scored at every place. Where these are
more than `MAX_SCORED`, they are scored on one window of `THIN`, and what then explains a share of
the best is scored again on all windows; some windows miss what happens seldom, such as a limit.

Where one size for all places and one place alone both fall short (friction under load at two
joints of six), all places are scored together, each with a size of its own. Places whose own size
is of a sign that physics does not admit, or not beyond its std, are then left out, and the others
are scored again. Of an effect that is felt only beside other things (`Effect.is_among`) the place
of the smallest size is left out where all others stay: what all have in common is no part of it.

What differs between records, such as a zero that is set before each of them, is a candidate with a
size of each record where several are fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.discovery.attempts import tell_lost
from identification.discovery.candidates import list_common, list_single
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import BY_RECORD, Candidate, Effect, in_each_record
from identification.effects.sizes import Size
from identification.prediction.fits.model import WindowModel
from identification.prediction.scoring.contenders import is_plausible, is_significant, refit_level
from identification.prediction.scoring.first_fit import (
    THIN,
    picks,
    thinned,
    thinned_moves,
    thinned_tangents,
)
from identification.prediction.scoring.scores import WindowScore, find_imitated, window_scores
from identification.windows.fit import WindowFit

AND = " and "  # between places, in words
MAX_SPREAD_EFFECTS = 4  # that are tried at several places; each takes a simulation for each place
MAX_LEAVING_ROUNDS = 3  # of leaving places out
MAX_SCORED = 300  # candidates that are scored on all windows at once: a minute of one core
MAX_SCORED_SHAPES = 2  # of an effect at a place, scored on all windows after that on some


def score_all(
    model: WindowModel, effects: Sequence[Effect], options: DiscoveryOptions
) -> tuple[WindowScore, ...]:
    """Returns scores of what a model lacks, at all places, at each, and at several, the best first.

    Args:
        model: fitted.
        effects: the candidates.
        options: what is beyond chance, and what is promising.
    """
    listed = _listed(model, effects, options)
    is_many = len(listed) > MAX_SCORED
    few = window_scores(some_windows(model.fit) if is_many else model.fit, listed)
    promising = _promising(few, options)
    again = {id(c) for c in promising}
    rest = [s for s in few if id(s.candidate) not in again]
    best = [*window_scores(model.fit, promising), *rest] if is_many else few
    tell_lost(listed, (s.candidate for s in best))
    found = sorted(best, key=lambda s: -s.fall)
    plausible, level = [s for s in found if is_plausible(s, options)], refit_level(found, options)
    asked = [s for s in plausible if is_significant(s, level, options)]
    if uses(options, "imitated_effects"):
        asked = [s for s in asked if id(s.candidate) in again or not is_many]
        known = find_imitated(model.fit, asked)
        found, plausible = (
            [s for s in each if s.candidate.key not in known] for each in (found, plausible)
        )
    strict = options.significance / max(1, len(found))
    beyond = [s for s in plausible if is_significant(s, strict, options)]
    is_each = uses(options, "several_places")
    several = several_scores(model, beyond, options) if is_each else []
    return tuple(sorted((*found, *several), key=lambda s: -s.fall))


def some_windows(fit: WindowFit, every: int = THIN) -> WindowFit:
    """Returns a fit seen through one window of `every`; its values are those of all windows.

    They are spread evenly: shares of the error and chances of luck are those of all windows.
    """
    at = picks(fit.tangents, every, is_loud=False)
    return replace(
        fit, problem=thinned(fit.problem, at), moves=thinned_moves(fit.moves, at),
        tangents=thinned_tangents(fit.tangents, at),
    )  # fmt: skip


def _listed(
    model: WindowModel, effects: Sequence[Effect], options: DiscoveryOptions
) -> list[Candidate]:
    """Returns all shapes of what the model lacks, at all places together and at each of them."""
    if not uses(options, "record_differences"):
        effects = [replace(e, of_records="") for e in effects]
    elif len(model.fit.problem.parts) > 1:
        effects = [*effects, *(in_each_record(e) for e in effects if e.of_records and not e.own)]
    has = {c.key for c in model.candidates}
    everywhere = {c.effect.name for c in model.candidates if not c.effect.places[c.where]}
    common = list_common([e for e in effects if e.name not in everywhere])
    # a record has one clock: what comes late at one input is a delay of this input
    several = [c for c in common if not c.effect.is_of_records]
    every = (c for c in (*common, *list_single(several)) if c.key not in has)
    return [c for c in every if has_what_it_needs(model, c)]


def has_what_it_needs(model: WindowModel, candidate: Candidate) -> bool:
    """Returns whether a model has the effect that a candidate changes, at all of its places."""
    needs, places = candidate.effect.needs, candidate.effect.places
    if not needs:
        return True
    values = {**model.plant.parameters.values(), **model.values}
    there = {
        name.partition("@")[2]
        for name, value in values.items()
        if name.startswith(f"{needs}.") and (value != 0 or name in model.fit.problem.names)
    }
    own = places[candidate.where].removeprefix("@")
    asked = {own} if own else {s.removeprefix("@") for s in places.values() if s} or {""}
    return "" in there or asked <= there


def _promising(scores: Sequence[WindowScore], options: DiscoveryOptions) -> list[Candidate]:
    """Returns candidates that may be refitted: plausible, with a share of the best one's gain."""
    count: dict[tuple[str, str], int] = {}
    plausible = [s for s in scores if is_plausible(s, options)]
    least = options.refit_share * max([s.gain for s in plausible], default=0.0)
    out = []
    for s in plausible:
        key = s.candidate.key
        count[key] = count.get(key, 0) + 1
        if s.gain >= least and count[key] <= MAX_SCORED_SHAPES:
            out.append(s.candidate)
    return out


def at_several(effect: Effect, places: Sequence[str]) -> Effect:
    """Returns the effect with one size for each of some places, acting on all of them.

    Args:
        effect: with these places among its own.
        places: in words, as in `Effect.places`.
    """
    sizes = tuple(
        replace(size, name=f"{size.name}{effect.places[where]}")
        for where in places
        for size in effect.sizes
    )
    return replace(effect, sizes=sizes, places={AND.join(places): ""})


def at_places(several: Effect, keep: Sequence[str]) -> Effect:
    """Returns an effect of `at_several` at some of its places.

    Args:
        several: with a size for each of its places.
        keep: those of its places that stay, in their order.
    """
    places = places_of(next(iter(several.places)))
    m = len(several.sizes) // len(places)
    sizes = tuple(
        size
        for k, where in enumerate(places)
        if where in keep
        for size in several.sizes[m * k : m * (k + 1)]
    )
    return replace(several, sizes=sizes, places={AND.join(keep): ""})


def places_of(where: str) -> list[str]:
    """Returns the places of an effect of `at_several` in words; of another effect its one place."""
    return where.split(AND)


def single_places(c: Candidate) -> list[str]:
    """Returns the single places at which a candidate acts, in words: all, several or one."""
    several = places_of(c.where)
    if len(several) > 1 or c.effect.places.get(c.where):
        return several
    return [where for where, suffix in c.effect.places.items() if suffix]


def contains(more: Candidate, less: Candidate) -> bool:
    """Returns whether a candidate is the same effect as another, at its places and at others."""
    is_same = more.effect.name == less.effect.name
    is_everywhere = not more.effect.places.get(more.where, more.where)
    return is_same and (is_everywhere or {*places_of(less.where)} <= {*places_of(more.where)})


def several_scores(
    model: WindowModel, significant: Sequence[WindowScore], options: DiscoveryOptions
) -> list[WindowScore]:
    """Returns scores of the best effects at several places.

    Args:
        model: without them.
        significant: scores that are beyond chance and plausible, the best first.
        options: what a size must be to count.
    """
    first: dict[tuple[str, bool], Candidate] = {}
    for s in significant:
        effect = s.candidate.effect
        is_single = not effect.own or s.candidate.where.endswith(BY_RECORD)
        if len(_places(model, s.candidate)) > 1 and is_single:
            first.setdefault((effect.name, effect.own), s.candidate)
    out: list[WindowScore] = []
    for c in [*first.values()][:MAX_SPREAD_EFFECTS]:
        places = _places(model, c)
        for _ in range(MAX_LEAVING_ROUNDS):
            found = window_scores(model.fit, [_at(c, places)])
            keep = felt_places(found[0], places, c.effect, options) if found else []
            if c.effect.is_among and len(keep) == len(_single(c.effect)):
                keep = _without_least(found[0], keep)
            if found and keep == places:
                out += found
            if keep == places or len(keep) < 2:
                break
            places = keep
    return out


def _without_least(score: WindowScore, places: Sequence[str]) -> list[str]:
    """Returns the places of a score with a size for each of them but the one of the least size."""
    least = int(np.argmin(np.abs(score.size)))
    return [where for k, where in enumerate(places) if k != least]


def felt_places(
    score: WindowScore, places: Sequence[str], effect: Effect, options: DiscoveryOptions
) -> list[str]:
    """Returns places where all sizes are plausible in sign and magnitude, and beyond their std."""
    sizes = effect.sizes * (len(score.size) // len(effect.sizes))
    pairs = zip(score.size, score.std, sizes, strict=True)
    felt = np.array([is_felt(*each, options) for each in pairs])
    whole = np.asarray(felt.reshape(-1, len(places), len(effect.sizes)).all(axis=2))
    # in any record, where sizes are each record's own
    return [where for k, where in enumerate(places) if whole[:, k].any()]


def is_felt(value: float, std: float, size: Size, options: DiscoveryOptions) -> bool:
    """Returns whether a size is beyond its std, and plausible in sign and magnitude."""
    return bool(
        size.sign * value >= 0
        and options.min_proof_t * std < abs(value) <= options.size_factor * size.largest
    )


def _places(model: WindowModel, c: Candidate) -> list[str]:
    """Returns the single places of an effect at which a model has what the effect changes."""
    return [w for w in _single(c.effect) if has_what_it_needs(model, replace(c, where=w))]


def _single(effect: Effect) -> list[str]:
    return [where for where, suffix in effect.places.items() if suffix]


def _at(c: Candidate, places: Sequence[str]) -> Candidate:
    effect = at_several(c.effect, places)
    return Candidate(effect, next(iter(effect.places)), c.shape, c.probe)
