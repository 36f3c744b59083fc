"""The effect that explains most is added, where unseen records prove it.

It must also hold where the fitted and the unseen records exchange their roles
(`identification.prediction.exchange`), and be simulated with steps that its own error allows.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.moves import Watch
from identification.discovery.passes import uses
from identification.prediction.exchange import exchanged, without_contradicted
from identification.prediction.extension import with_fitting_steps
from identification.prediction.model import WindowModel
from identification.prediction.screening import score_all
from identification.prediction.selection import refit_contenders
from identification.prediction.task import WindowSearch
from identification.prediction.trial import Contender, find_rivals
from identification.progress import Progress


def add_effect(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with the best effect that unseen records prove, or what was refitted."""
    task, watch = state.task, Watch(state.seconds)
    parent, tried = refit_contenders(
        state.model, state.scores, task.horizon, task.confirm, task.options, progress,
        None if state.accepted else state.worse_fit, task.nominal_model.guessed,
    )  # fmt: skip
    nominal = state.nominal if state.accepted else parent
    state = replace(state, model=parent, nominal=nominal)
    model = None
    while model is None:  # a model that its own steps let diverge is none: the next one is asked
        tried, other_side = _checked(state, tried, progress)
        if not tried or not tried[0].is_proven:
            watch.stop("refits")
            return replace(state, rejected=tried, seconds=watch.seconds)
        best = tried[0]
        shorter = partial(with_fitting_steps, best.model, task.horizon, task.confirm)
        model = attempt(best.candidate, shorter)
        tried = tried if model else tried[1:]
    watch.stop("refits")
    scores = score_all(model, task.effects, task.options)
    others = find_rivals(tried[1:], state.model, state.scores, best.model, scores)
    watch.stop("scores")
    accepted = (*state.accepted, replace(best, alternatives=others))
    return replace(
        state, model=model, accepted=accepted, scores=scores, rejected=(), seconds=watch.seconds,
        exchanged=other_side,
    )  # fmt: skip


def _checked(
    state: WindowSearch, tried: tuple[Contender, ...], progress: Progress
) -> tuple[tuple[Contender, ...], WindowModel | None]:
    """Returns contenders, contradicted ones unproven, and the first one with roles exchanged.

    Where the search began at values that no fit found, there is nothing to exchange.
    """
    task = state.task
    begun_elsewhere = state.worse_fit is not None and not state.accepted
    is_asked = uses(task.options, "exchange_roles") and not begun_elsewhere
    if not is_asked or not tried or not tried[0].is_proven:
        return tried, None
    without = state.exchanged or exchanged(state.model, task.records, task.horizon)
    if without is None:
        return tried, None
    return without_contradicted(tried, without, task.records, task.horizon, task.options, progress)
