"""The effect that explains most is added, where unseen records prove it.

It must also hold where the fitted and the unseen records exchange their roles
(`identification.prediction.selection.exchange`), and be simulated with steps that its own error
allows. Where the steps themselves may make it (`identification.prediction.selection.finer_steps`),
it is asked again with finer ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.moves import Watch
from identification.discovery.passes import uses
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import weighed, with_fitting_steps
from identification.prediction.judging.trial import Contender, find_rivals
from identification.prediction.scoring.screening import score_all
from identification.prediction.selection.edges import without_edges
from identification.prediction.selection.exchange import (
    exchanged,
    missing_chance_alone,
    with_both_roles,
    without_contradicted,
)
from identification.prediction.selection.finer_steps import (
    at_finer_steps,
    is_made_by_steps,
    is_of_steps,
)
from identification.prediction.selection.selection import first_not_imitated, refit_contenders
from identification.prediction.task import WindowSearch
from identification.quantities import quantity
from identification.runtime.progress import Progress
from identification.windows.coarse import steps_of


def add_effect(state: WindowSearch, progress: Progress, are_curves: bool = False) -> WindowSearch:
    """Returns the state with the best effect that unseen records prove, or what was refitted.

    Args:
        state: the state before.
        progress: is told what is refitted.
        are_curves: whether curves of the data are asked, or laws.
    """
    task, watch = state.task, Watch(state.seconds)
    parent, tried = refit_contenders(
        state.model, state.scores, task.horizon, task.confirm, task.options, progress,
        None if state.accepted else state.worse_fit, () if are_curves else task.suggested,
        are_curves, len(state.rejected) if are_curves else 0,
    )  # fmt: skip
    nominal = state.nominal if state.accepted else parent
    state = replace(state, model=parent, nominal=nominal)
    state, tried = _proven_by_both(state, tried)
    if _may_be_of_steps(state, tried):
        watch.stop("refits")
        finer = at_finer_steps(state)
        if finer is not None:
            c, (taken, _) = tried[0].candidate, steps_of(finer.model.plant)
            progress(
                f"{c.effect.name}, {c.where}: the steps of the simulation may make it; the search"
                f" goes on with steps of {quantity(taken, unit='s')}"
            )
            return add_effect(replace(finer, seconds=watch.seconds), progress, are_curves)
        tried = _without_made(state, tried)
    model = None
    while model is None:  # a model that its own steps let diverge is none: the next one is asked
        tried, other_side = _checked(state, tried, progress)
        if not tried or not tried[0].is_proven:
            watch.stop("refits")
            rejected = (*state.rejected, *tried) if are_curves else tried
            return replace(state, rejected=rejected, seconds=watch.seconds)
        best = tried[0]
        shorter = partial(with_fitting_steps, best.model, task.horizon, task.confirm)
        model = attempt(best.candidate, shorter)
        tried = tried if model else tried[1:]
    model = weighed(model, task.horizon, task.confirm, task.options)
    found = replace(state, model=model, exchanged=other_side)
    if best.candidate.effect.is_of_records:
        found = attempt(None, partial(without_edges, found)) or found
    model = found.model
    watch.stop("refits")
    scores = score_all(model, task.effects, task.options)
    others = find_rivals(tried[1:], state.model, state.scores, best.model, scores)
    watch.stop("scores")
    accepted = (*state.accepted, replace(best, alternatives=others))
    return replace(found, accepted=accepted, scores=scores, rejected=(), seconds=watch.seconds)


def _proven_by_both(
    state: WindowSearch, tried: tuple[Contender, ...]
) -> tuple[WindowSearch, tuple[Contender, ...]]:
    """Returns contenders, the likeliest judged by both roles of the records where chance is all.

    The state keeps the fit of the model without them to the records that confirm.
    """
    task = state.task
    is_asked = uses(task.options, "proof_by_both_roles") and _may_exchange(state)
    if not is_asked or missing_chance_alone(tried, task.options) is None:
        return state, tried
    without = state.exchanged or exchanged(state.model, task.records, task.horizon)
    if without is None:
        return state, tried
    found = with_both_roles(tried, without, task.records, task.horizon, task.options)
    return replace(state, exchanged=without), first_not_imitated(state.model, found, task.options)


def _may_exchange(state: WindowSearch) -> bool:
    """Returns whether a fit began the search; other values have nothing to exchange."""
    return state.worse_fit is None or bool(state.accepted)


def _may_be_of_steps(state: WindowSearch, tried: Sequence[Contender]) -> bool:
    """Returns whether finer steps are to be asked of the effect that is to be accepted.

    Values that no fit found have no finer fit.
    """
    is_fitted = state.worse_fit is None or bool(state.accepted)
    is_asked = is_fitted and uses(state.task.options, "finer_steps")
    is_proven = bool(tried) and tried[0].is_proven
    return is_asked and is_proven and is_of_steps(state.model, tried[0])


def _without_made(state: WindowSearch, tried: Sequence[Contender]) -> tuple[Contender, ...]:
    """Returns contenders, those unproven and behind the others that the finest steps still make."""
    is_made = [c.is_proven and is_made_by_steps(state.model, c) for c in tried]
    rest = [c for c, made in zip(tried, is_made, strict=True) if not made]
    made = [replace(c, doubt="steps") for c, made in zip(tried, is_made, strict=True) if made]
    return (*rest, *made)


def _checked(
    state: WindowSearch, tried: tuple[Contender, ...], progress: Progress
) -> tuple[tuple[Contender, ...], WindowModel | None]:
    """Returns contenders, contradicted ones unproven, and the first one with roles exchanged."""
    task = state.task
    is_asked = uses(task.options, "exchange_roles") and _may_exchange(state)
    if not is_asked or not tried or not tried[0].is_proven:
        return tried, None
    without = state.exchanged or exchanged(state.model, task.records, task.horizon)
    if without is None:
        return tried, None
    return without_contradicted(tried, without, task.records, task.horizon, task.options, progress)
