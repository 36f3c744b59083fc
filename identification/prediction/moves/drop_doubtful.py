"""Effects in doubt, beside others that are sure.

On a real robot no law is exact. The first law found may be the right name of most of what is
missing, and those found later may be neighbours' names of what it leaves. So effects against which
something speaks (`identification.prediction.doubts`) are taken out; the others are fitted again and
asked again, until nothing speaks against any. What the model then lacks is told as what is left.
Where all are in doubt, the last one is taken out first. Where no law is sure at the end, all stay,
and the verdict tells that none is a name: a curve alone would draw what the others explain, too.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.moves import Watch
from identification.prediction.doubts import doubts_of_names, forbidden_of, laws_of, names_of
from identification.prediction.extension import refitted
from identification.prediction.remaining import is_off
from identification.prediction.screening import score_all
from identification.prediction.task import WindowSearch
from identification.prediction.trial import Contender, Doubt
from identification.progress import Progress


def drop_doubtful(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state without effects in doubt; the state itself where all are, or none is."""
    watch = Watch(state.seconds)
    now, lost = state, list[Contender]()
    while True:
        laws = laws_of(now)
        if len(laws) == 1 and now is state:
            return state
        doubts = _doubts(now)
        if not any(doubts):
            break
        doubtful = {a.candidate.key: d for a, d in zip(laws, doubts, strict=True) if d}
        if len(doubtful) == len(laws):
            doubtful = dict([[*doubtful.items()][-1]])
        rest = [a for a in laws if a.candidate.key not in doubtful]
        if all(a.candidate.effect.is_curve for a in rest):
            return state
        less = _without(now, doubtful)
        if less is None:
            return state
        lost = [*(replace(a, doubt=doubtful[a.candidate.key]) for a in laws
                  if a.candidate.key in doubtful), *lost]  # fmt: skip
        now = less
    if now is state:
        return state
    for a in lost:
        progress(f"{a.candidate.effect.name}, {a.candidate.where}: is in doubt, others are sure")
    watch.stop("refits")
    return replace(now, rejected=(*lost, *state.rejected), seconds=watch.seconds)


def _doubts(state: WindowSearch) -> tuple[Doubt | None, ...]:
    """Returns what speaks against each effect that may be named."""
    options = state.task.options
    named, _ = names_of(state, options.max_confidence, is_off(state.model, options))
    return doubts_of_names(named, forbidden_of(state), (), 1.0, options)


def _without(state: WindowSearch, doubtful: dict[tuple[str, str], Doubt]) -> WindowSearch | None:
    """Returns the state whose model is fitted without some effects; None where it cannot be."""
    task = state.task
    rest = [c for c in state.model.candidates if c.key not in doubtful]
    model = refitted(state.model, rest, task.nominal_model, task.confirm)
    if model is None:
        return None
    scores = attempt(None, partial(score_all, model, task.effects, task.options))
    return replace(
        state, model=model, scores=scores or state.scores,
        accepted=tuple(a for a in state.accepted if a.candidate.key not in doubtful),
    )  # fmt: skip
