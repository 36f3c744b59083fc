"""The members of a set of effects, each the best of what was refitted in its place.

A set is chosen by what its members explain together, in a linear model. So each of them is taken
out and compared with all other laws in its place, beside the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.evidence import all_gains, evidence
from identification.prediction.judging.extension import refitted
from identification.prediction.judging.trial import Contender, find_rivals
from identification.prediction.scoring.contenders import count_numbers
from identification.prediction.scoring.scores import WindowScore
from identification.prediction.scoring.screening import score_all
from identification.prediction.selection.selection import refit_contenders
from identification.prediction.selection.set_choice import find_members
from identification.prediction.task import WindowSearch
from identification.runtime.progress import Progress

Key = tuple[str, str]  # of a candidate: its effect and its place


@dataclass(frozen=True)
class Place:
    """What was refitted in the place of a member of a set, beside the others."""

    without: WindowModel  # the model without the member
    scores: tuple[WindowScore, ...]  # on it
    tried: tuple[Contender, ...]  # what was refitted


def each_at_its_best(
    state: WindowSearch, model: WindowModel, progress: Progress
) -> tuple[WindowModel, dict[Key, Place]]:
    """Returns the model in which each member is the best in its place, and what was tried there."""
    task, options = state.task, state.task.options
    is_plain = uses(options, "plain_sets")
    laws = [
        e for e in task.effects
        if not e.is_curve and not e.is_of_records and not (is_plain and e.state)
    ]  # fmt: skip
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
    gains = all_gains(parent, model, options)
    return float(evidence([gains], [numbers], len(parent.scale))[0, 0])


def with_rivals(
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
    more = member.gains.blocks - own.gains.blocks
    return replace(member, alternatives=tuple(
        replace(o, gains=replace(member.gains, blocks=o.gains.blocks + more)) for o in rivals
    ))  # fmt: skip
