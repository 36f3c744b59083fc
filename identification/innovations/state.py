"""The search by the innovations of a free run: its state, and the moves that it is asked.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  prove on unseen samples
                                   ^_____________________________________________|   again, with it
then parts that deviate by more than parts do  ->  drop, exchange
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from identification.discovery.attempts import collected, tell_lost
from identification.discovery.candidates import list_common, list_single
from identification.discovery.moves import Move, SearchState, Watch, drop_needless
from identification.discovery.outlook import SCORES
from identification.discovery.passes import uses
from identification.innovations.fitted_model import (
    AcceptedEffect,
    FittedModel,
    fit_model,
    has_candidate,
    score_candidates,
)
from identification.innovations.moves.deviants import accept_deviants, within_bounds
from identification.innovations.moves.forward_selection import select_effect
from identification.innovations.moves.kinds import improve_kinds
from identification.innovations.moves.pairs import find_pair
from identification.innovations.moves.pruning import exchange, without_needless
from identification.innovations.proof import divide_unseen
from identification.innovations.scoring.scores import Score
from identification.innovations.scoring.sensitivities import (
    Sensitivity,
    compute_sensitivities,
    forget_records,
)
from identification.innovations.task import DiscoveryTask
from identification.model.sensitivity import refuse_without_effect
from identification.quantities import held
from identification.runtime.heap import release
from identification.runtime.progress import Progress, enter


@dataclass(frozen=True, kw_only=True)
class InnovationSearch(SearchState):
    """A search by the innovations of a free run."""

    accepted: tuple[AcceptedEffect, ...]
    # of all candidates, at the model; of those that it has, at the fit before
    sensitivities: tuple[Sensitivity, ...]
    # the likeliest model of the last round that is half proven; None without one
    unproven: FittedModel | None = None


def first_state(task: DiscoveryTask, progress: Progress) -> InnovationSearch:
    """Returns the state after the nominal fit: nothing is accepted, and all candidates are scored.

    Args:
        task: what is asked.
        progress: is told a line per step.

    Raises:
        InputError: a free parameter has no effect on any output.
        DivergenceError: the nominal model cannot be simulated.
    """
    watch = Watch()
    nominal = fit_model(task, (), {})
    refuse_without_effect(nominal.refit.point.J, task.nominal_model.names, task.log)
    if task.nominal_model.scattering:
        task, nominal = _with_scatter(task, nominal)
    parts = divide_unseen(nominal.validation, task.options)
    task = replace(task, parts=parts)
    nominal = replace(nominal, validation=replace(nominal.validation, parts=parts))
    watch.stop("nominal fit")
    progress(f"nominal fit: {held(1e3 * nominal.validation.rms('select'))}e-3 on unseen data")
    enter(SCORES)
    with collected(progress) as failed:
        sensitivities = _compute_all_sensitivities(task, nominal, ())
    watch.stop("sensitivities")
    scores = score_candidates(nominal, sensitivities, task.options)
    watch.stop("scores")
    progress(f"{len(scores)} candidates scored, {scores[0].candidate.effect.name} first")
    return InnovationSearch(
        task=task, moves=(), nominal=nominal, sensitivities=sensitivities,
        nominal_scores=scores, model=nominal, accepted=(), scores=scores, rejected=(),
        seconds=watch.seconds, failed=tuple(failed),
    )  # fmt: skip


def _with_scatter(task: DiscoveryTask, nominal: FittedModel) -> tuple[DiscoveryTask, FittedModel]:
    """Returns the task with the scatter that the nominal fit shows, and a nominal fit under it."""
    model = task.nominal_model
    groups = {group: model.groups[group] for group in model.scattering}
    scatter = nominal.refit.problem.scatter(groups)
    task = replace(task, nominal_model=replace(model, scatter=scatter))
    return task, fit_model(task, (), nominal.refit.point.values, nominal)


def add_effect(state: InnovationSearch, progress: Progress) -> InnovationSearch:
    """Returns the state with the best effect that unseen samples prove, or what was refitted."""
    watch = Watch(state.seconds)
    release()
    selection = select_effect(state.task, state.model, state.scores, progress)
    watch.stop("refits")
    if selection.accepted:
        return _grown(state, selection.accepted, watch)
    return replace(
        state, rejected=selection.rejected, unproven=selection.unproven, seconds=watch.seconds
    )


def add_pair(state: InnovationSearch, progress: Progress) -> InnovationSearch:
    """Returns the state with two effects of which none was proven alone."""
    task, first = state.task, state.unproven
    if first is None or state.room < 2:
        return state
    watch = Watch(state.seconds)
    along = _compute_all_sensitivities(task, first, state.sensitivities)
    new = find_pair(task, state.model, first, along, progress)
    watch.stop("refits")
    return _grown(state, new, watch) if new else replace(state, seconds=watch.seconds)


def add_deviants(state: InnovationSearch, progress: Progress) -> InnovationSearch:
    """Makes effects of parts that deviate by more than parts do, once no candidate is left.

    Before, a part may deviate only because the model lacks something else.
    """
    task, watch = state.task, Watch(state.seconds)
    parent, new = accept_deviants(task, state.model, state.room, progress)
    watch.stop("refits")
    if not new:
        return replace(state, seconds=watch.seconds)
    nominal = state.nominal if state.accepted else parent
    accepted = (*state.accepted, *new)
    state = replace(state, task=within_bounds(task), nominal=nominal, accepted=accepted)
    return _scored(replace(state, rejected=(), unproven=None), new[-1].model, watch)


def drop_effects(state: InnovationSearch, progress: Progress) -> InnovationSearch:
    """Returns the state without effects that later ones have made needless."""
    watch = Watch(state.seconds)
    without = partial(without_needless, state.task)
    kept, model = drop_needless(state.model, state.accepted, without, progress)
    return _pruned(state, kept, model, watch)


def exchange_effects(state: InnovationSearch, progress: Progress) -> InnovationSearch:
    """Returns the state with rivals in the place of effects, where the model is then better."""
    del progress
    watch = Watch(state.seconds)
    kept, model = exchange(
        state.task, state.nominal, state.accepted, state.model, state.sensitivities
    )
    return _pruned(state, kept, model, watch)


MOVES = (
    Move("add_effect", add_effect, grows=True),
    Move("add_pair", add_pair, grows=True),
    Move("add_deviants", add_deviants, grows=True),
    Move("drop_effects", drop_effects),
    Move("exchange_effects", exchange_effects),
)


def _grown(
    state: InnovationSearch, new: Sequence[AcceptedEffect], watch: Watch
) -> InnovationSearch:
    """Returns the state with more effects, each of its likeliest kind beside the others."""
    accepted, model = (*state.accepted, *new), new[-1].model
    if len(accepted) > 1 and uses(state.task.options, "other_kinds"):
        accepted, model = improve_kinds(state.task, accepted, model, state.sensitivities)
        watch.stop("refits")
    return _scored(replace(state, accepted=accepted, rejected=(), unproven=None), model, watch)


def _scored(state: InnovationSearch, model: FittedModel, watch: Watch) -> InnovationSearch:
    """Returns the state with a model that has more effects, and the scores of all others on it.

    What was missing has moved the trajectory: a friction's sensitivity along the wrong one, where
    the rollers turn back at other times, says little of the right one.
    """
    sensitivities = _compute_all_sensitivities(state.task, model, state.sensitivities)
    watch.stop("sensitivities")
    scores = score_candidates(model, sensitivities, state.task.options)
    watch.stop("scores")
    return replace(
        state, model=model, sensitivities=sensitivities, scores=scores, seconds=watch.seconds
    )


def _pruned(
    state: InnovationSearch, kept: tuple[AcceptedEffect, ...], model: FittedModel, watch: Watch
) -> InnovationSearch:
    """Returns the state with fewer or other effects, and the scores of all others on its model."""
    watch.stop("refits")
    scores = state.scores
    if model is not state.model:
        scores = score_candidates(model, state.sensitivities, state.task.options)
        watch.stop("scores")
    return replace(state, model=model, accepted=kept, scores=scores, seconds=watch.seconds)


def _compute_all_sensitivities(
    task: DiscoveryTask, model: FittedModel, before: tuple[Sensitivity, ...]
) -> tuple[Sensitivity, ...]:
    """Computes sensitivities of effects on all places, and of the best shape at each single one.

    Those of effects that the model has stay what they were before.
    """
    point = model.refit.point
    kept = tuple(s for s in before if has_candidate(model, s.candidate))
    left = [c for c in list_common(task.effects) if not has_candidate(model, c)]
    common = compute_sensitivities(point, left)
    tell_lost(left, (s.candidate for s in common))
    best: dict[str, Score] = {}
    for s in score_candidates(model, common, task.options):
        best.setdefault(s.candidate.effect.name, s)
    single = list_single([s.candidate for s in best.values()])
    left = [c for c in single if not has_candidate(model, c)]
    alone = compute_sensitivities(point, left)
    forget_records()
    tell_lost(left, (s.candidate for s in alone))
    return kept + common + alone
