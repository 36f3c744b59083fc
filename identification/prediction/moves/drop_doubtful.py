"""Effects in doubt, beside others that are sure.

On a real robot no law is exact. The first law found may be the right name of most of what is
missing, and those found later may be neighbours' names of what it leaves. So effects against which
something speaks (`identification.prediction.verdict.doubts`) are taken out, and the others are
fitted again. What the model then lacks is told as what is left.

Each name is judged in the model that has all effects, because what else is missing would speak
against it in a smaller one. There an effect in doubt counts as what is beside a law, where it may
be a part of what the law misses: the law then may be in doubt, too. Where no law is sure, all
effects stay, and the verdict tells that none is a name: a curve alone would draw what the others
explain, too.

Of several laws that are sure, all but the one with the most evidence must explain nearly all of
what smooth forces of their joints could. What a law that is not exact leaves is a smooth force, and
of that the nearest law of the catalogue explains much, wherever it acts. A curve must explain half
of it: else what is missing there follows another variable.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.effect_results import NamedEffect
from identification.discovery.moves import Watch
from identification.discovery.passes import uses
from identification.prediction.judging.extension import refitted
from identification.prediction.judging.trial import Contender
from identification.prediction.scoring.screening import score_all
from identification.prediction.selection.set_members import Key
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.doubts import (
    doubts_of_names,
    forbidden_of,
    laws_of,
    names_of,
)
from identification.prediction.verdict.neighbours import has_neighbours_name, neighbour_of
from identification.prediction.verdict.remaining import is_off
from identification.runtime.progress import Progress

# Least share of a law beside a surer one, of what it and smooth forces of its joint explain. Of
# worlds without exact laws whose answers were kept, 10 of 14 laws that were not there had less, and
# 1 of 6 that were there; all laws beside exact ones had more. Present rates: docs/robot/models.md.
MIN_FURTHER_SHARE = 0.92
# The same of a curve. Of 118 curves in worlds whose answers were kept, one was not of what was
# hidden, and had 0.22; all others had 0.5 or more.
MIN_CURVE_SHARE = 0.5


def drop_doubtful(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state without effects in doubt; the state itself where all are, or none is."""
    watch, laws = Watch(state.seconds), laws_of(state)
    if len(laws) == 1:
        return state
    sure, doubtful = sure_and_doubtful(state)
    if not doubtful or all(a.candidate.effect.is_curve for a in sure):
        return state
    less = fitted_without(state, sure, {a.candidate.key for a in doubtful})
    if less is None:
        return state
    for a in doubtful:
        progress(f"{a.candidate.effect.name}, {a.candidate.where}: is in doubt, others are sure")
    watch.stop("refits")
    return replace(less, rejected=(*doubtful, *state.rejected), seconds=watch.seconds)


def sure_and_doubtful(state: WindowSearch) -> tuple[list[Contender], list[Contender]]:
    """Returns the effects whose names are sure beside all others, and those in doubt, with why."""
    options, laws = state.task.options, laws_of(state)
    named, stick = names_of(state, options.max_confidence, is_off(state.model, options))
    doubts = doubts_of_names(named, forbidden_of(state), (), 1.0, options)
    why = {a.candidate.key: d for a, d in zip(laws, doubts, strict=True) if d is not None}
    if uses(options, "further_laws"):
        rest = [n for n in named if n.candidate.key not in why]
        why |= dict.fromkeys(rough_laws(rest) | wrong_curves(rest), "further")
    while True:
        beside = [a for a in laws if a.candidate.key in why]
        sure = [replace(a, neighbour=neighbour_of(a, state, stick, beside))
                for a in laws if a.candidate.key not in why]  # fmt: skip
        more = [a for a in sure if has_neighbours_name(a.neighbour, options)]
        if not more:
            return sure, [replace(a, doubt=why[a.candidate.key]) for a in beside]
        why |= {a.candidate.key: "neighbour" for a in more}


def fitted_without(
    state: WindowSearch, sure: Sequence[Contender], doubtful: Collection[Key]
) -> WindowSearch | None:
    """Returns the state whose model is fitted without effects in doubt; None where it cannot be."""
    task, judged = state.task, {a.candidate.key: a for a in sure}
    rest = [c for c in state.model.candidates if c.key not in doubtful]
    model = refitted(state.model, rest, task.nominal_model, task.confirm)
    if model is None:
        return None
    scores = attempt(None, partial(score_all, model, task.effects, task.options))
    return replace(
        state, model=model, scores=scores or state.scores,
        accepted=tuple(
            judged.get(a.candidate.key, a)
            for a in state.accepted if a.candidate.key not in doubtful
        ),
    )  # fmt: skip


def rough_laws(named: Sequence[NamedEffect]) -> set[Key]:
    """Returns further laws of joints that explain too little of what smooth forces there could.

    The law with the most evidence is none of them: it may be most of what is missing, and need not
    be exact.

    Args:
        named: effects against which nothing else speaks.
    """
    laws = sorted((n for n in named if not n.candidate.effect.is_curve), key=lambda n: -n.evidence)
    return {
        n.candidate.key
        for n in laws[1:]
        if n.smooth_share is not None and n.smooth_share < MIN_FURTHER_SHARE
    }


def wrong_curves(named: Sequence[NamedEffect]) -> set[Key]:
    """Returns curves that explain too little of what smooth forces of their joints could.

    Args:
        named: effects against which nothing else speaks.
    """
    return {
        n.candidate.key
        for n in named
        if n.candidate.effect.is_curve
        and n.smooth_share is not None and n.smooth_share < MIN_CURVE_SHARE
    }  # fmt: skip
