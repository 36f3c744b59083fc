"""Scores of all that a model lacks: everything on some windows, what is promising on all of them.

A score of one place is worth as much as one of all places, and a shape that is best for all places
together may be wrong for each of them. So every shape is scored at every place. Where these are
more than `MAX_SCORED`, they are scored on one window of `THIN`, and what then explains a share of
the best is scored again on all windows; some windows miss what happens seldom, such as a limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from identification.discovery.attempts import tell_lost
from identification.discovery.candidates import list_common, list_single
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate, Effect
from identification.prediction.contenders import is_plausible, is_significant
from identification.prediction.fit import WindowFit
from identification.prediction.model import WindowModel
from identification.prediction.scores import WindowScore, find_imitated, window_scores
from identification.prediction.several_places import several_scores
from identification.prediction.thinning import picks, thinned, thinned_moves, thinned_tangents

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
    listed = _listed(model, effects)
    is_many = len(listed) > MAX_SCORED
    few = window_scores(some_windows(model.fit) if is_many else model.fit, listed)
    promising = _promising(few, options)
    again = {id(c) for c in promising}
    rest = [s for s in few if id(s.candidate) not in again]
    best = [*window_scores(model.fit, promising), *rest] if is_many else few
    tell_lost(listed, (s.candidate for s in best))
    found = sorted(best, key=lambda s: -s.fall)
    beyond = [
        s for s in found if is_significant(s, len(found), options) and is_plausible(s, options)
    ]
    asked = [s for s in beyond if id(s.candidate) in again or not is_many]
    if uses(options, "imitated_effects"):
        known = find_imitated(model.fit, asked)
        found, beyond = (
            [s for s in each if s.candidate.key not in known] for each in (found, beyond)
        )
    is_each = uses(options, "several_places")
    several = several_scores(model.fit, beyond, options) if is_each else []
    return tuple(sorted((*found, *several), key=lambda s: -s.fall))


def some_windows(fit: WindowFit) -> WindowFit:
    """Returns a fit seen through one window of `THIN`; its values are those of all windows."""
    at = picks(fit.tangents)
    return replace(
        fit, problem=thinned(fit.problem, at), moves=thinned_moves(fit.moves, at),
        tangents=thinned_tangents(fit.tangents, at),
    )  # fmt: skip


def _listed(model: WindowModel, effects: Sequence[Effect]) -> list[Candidate]:
    """Returns all shapes of what the model lacks, at all places together and at each of them."""
    has = {c.key for c in model.candidates}
    everywhere = {c.effect.name for c in model.candidates if not c.effect.places[c.where]}
    common = list_common([e for e in effects if e.name not in everywhere])
    every = (c for c in (*common, *list_single(common)) if c.key not in has)
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
