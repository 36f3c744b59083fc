"""The state of a search, and its steps: the nominal fit, rounds of selection, and pruning.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  prove on unseen samples
                                   ^_____________________________________________|   again, with it
then parts that deviate by more than parts do  ->  pruning
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from identification.discovery.attempts import Failed, attempt, collected, tell_lost
from identification.discovery.deviants import accept_deviants, within_bounds
from identification.discovery.effect_results import RejectedEffect
from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    fit_model,
    has_candidate,
    score_candidates,
)
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.sensitivities import (
    Sensitivity,
    compute_sensitivities,
    list_common,
    list_single,
)
from identification.discovery.selection.forward_selection import select_effect
from identification.discovery.selection.kinds import improve_kinds
from identification.discovery.selection.pairs import find_pair
from identification.discovery.selection.pruning import prune
from identification.discovery.task import DiscoveryTask
from identification.estimation.options import Progress
from identification.kalman.hierarchy import estimate_scatter
from identification.model.sensitivity import refuse_without_effect
from identification.quantities import held

Stage = Literal["selection", "deviants", "pruning", "finished"]


@dataclass(frozen=True, kw_only=True)
class SearchState:
    """All that a search knows after a step.

    Attributes:
        task: what is asked.
        stage: what the next step does.
        nominal: the fitted model without effects.
        sensitivities: of all candidates, at the model; of those that it has, at the fit before.
        nominal_scores: of all candidates on the nominal fit, the best first.
        model: the fitted model with the accepted effects.
        accepted: the effects that were accepted, in that order.
        scores: of the candidates that the model does not have, on it, the best first.
        rejected: what the last round refitted and did not accept, the best first.
        seconds: wall time by kind of work [s].
        failed: what was tried and could not be evaluated.
    """

    task: DiscoveryTask
    stage: Stage
    nominal: FittedModel
    sensitivities: tuple[Sensitivity, ...]
    nominal_scores: tuple[Score, ...]
    model: FittedModel
    accepted: tuple[AcceptedEffect, ...]
    scores: tuple[Score, ...]
    rejected: tuple[RejectedEffect, ...]
    seconds: Mapping[str, float]
    failed: tuple[Failed, ...] = ()

    @property
    def is_finished(self) -> bool:
        """Whether there is nothing left to try."""
        return self.stage == "finished"


def first_state(task: DiscoveryTask, progress: Progress) -> SearchState:
    """Returns the state after the nominal fit: nothing is accepted, and all candidates are scored.

    Args:
        task: what is asked.
        progress: is told a line per step.

    Raises:
        InputError: a free parameter has no effect on any output.
        DivergenceError: the nominal model cannot be simulated.
    """
    watch = _Watch()
    nominal = fit_model(task, (), {})
    refuse_without_effect(nominal.refit.point.J, task.nominal_model.names, task.log)
    if task.nominal_model.scattering:
        task, nominal = _with_scatter(task, nominal)
    watch.stop("nominal fit")
    progress(f"nominal fit: {held(1e3 * nominal.validation.rms)}e-3 on unseen data")
    with collected(progress) as failed:
        sensitivities = _compute_all_sensitivities(task, nominal, ())
    watch.stop("sensitivities")
    scores = score_candidates(nominal, sensitivities, task.options)
    watch.stop("scores")
    progress(f"{len(scores)} candidates scored, {scores[0].candidate.effect.name} first")
    return SearchState(
        task=task, stage="selection", nominal=nominal, sensitivities=sensitivities,
        nominal_scores=scores, model=nominal, accepted=(), scores=scores, rejected=(),
        seconds=watch.seconds, failed=tuple(failed),
    )  # fmt: skip


def next_state(state: SearchState, progress: Progress) -> SearchState:
    """Returns the state after one more step; a finished state stays as it is.

    A step that fails is told and skipped: what was found before it stands.

    Args:
        state: the state before.
        progress: is told a line per refit.
    """
    if state.is_finished:
        return state
    steps: dict[Stage, tuple[Callable[[], SearchState], Stage]] = {
        "selection": (partial(_select, state, progress), "deviants"),
        "deviants": (partial(_deviate, state, progress), "pruning"),
        "pruning": (partial(_prune, state), "finished"),
    }
    step, after = steps[state.stage]
    with collected(progress, state.failed) as failed:
        new = attempt(f"the {state.stage}", step) or replace(state, stage=after)
    return replace(new, failed=tuple(failed))


def _with_scatter(task: DiscoveryTask, nominal: FittedModel) -> tuple[DiscoveryTask, FittedModel]:
    """Returns the task with the scatter that the nominal fit shows, and a nominal fit under it."""
    model = task.nominal_model
    groups = {group: model.groups[group] for group in model.scattering}
    scatter = estimate_scatter(nominal.refit, groups)
    task = replace(task, nominal_model=replace(model, scatter=scatter))
    return task, fit_model(task, (), nominal.refit.point.values, nominal)


def _select(state: SearchState, progress: Progress) -> SearchState:
    """Returns the state after a round of selection: an effect or a pair is added, or none."""
    task, watch = state.task, _Watch(state.seconds)
    most = task.options.max_effects - len(state.accepted)
    selection = select_effect(task, state.model, state.scores, progress)
    new = selection.accepted
    if selection.unproven is not None and most >= 2:
        first = selection.unproven
        along = _compute_all_sensitivities(task, first, state.sensitivities)
        new = find_pair(task, state.model, first, along, progress)
    watch.stop("refits")
    if not new:
        rejected = selection.rejected
        return replace(state, stage="deviants", rejected=rejected, seconds=watch.seconds)
    accepted, model = (*state.accepted, *new), new[-1].model
    if len(accepted) > 1:
        accepted, model = improve_kinds(task, accepted, model, state.sensitivities)
        watch.stop("refits")
    state = replace(state, accepted=accepted, rejected=())
    return _scored(state, model, "selection" if most > len(new) else "pruning", watch)


def _deviate(state: SearchState, progress: Progress) -> SearchState:
    """Makes effects of parts that deviate by more than parts do, once no candidate is left.

    Before, a part may deviate only because the model lacks something else.
    """
    task, watch = state.task, _Watch(state.seconds)
    room = task.options.max_effects - len(state.accepted)
    parent, new = accept_deviants(task, state.model, room, progress)
    watch.stop("refits")
    if not new:
        return replace(state, stage="pruning", seconds=watch.seconds)
    task, model = within_bounds(task), new[-1].model
    nominal = state.nominal if state.accepted else parent
    accepted = (*state.accepted, *new)
    state = replace(state, task=task, nominal=nominal, accepted=accepted, rejected=())
    return _scored(state, model, "selection" if room > len(new) else "pruning", watch)


def _scored(state: SearchState, model: FittedModel, stage: Stage, watch: _Watch) -> SearchState:
    """Returns the state with a model that has more effects, and the scores of all others on it.

    What was missing has moved the trajectory: a friction's sensitivity along the wrong one, where
    the rollers turn back at other times, says little of the right one.
    """
    sensitivities = _compute_all_sensitivities(state.task, model, state.sensitivities)
    watch.stop("sensitivities")
    scores = score_candidates(model, sensitivities, state.task.options)
    watch.stop("scores")
    return replace(
        state, stage=stage, model=model, sensitivities=sensitivities, scores=scores,
        seconds=watch.seconds,
    )  # fmt: skip


def _prune(state: SearchState) -> SearchState:
    """Drop or exchange accepted effects; the search is then finished."""
    task, watch = state.task, _Watch(state.seconds)
    kept, model = prune(task, state.nominal, state.accepted, state.model, state.sensitivities)
    watch.stop("refits")
    scores = state.scores
    if model is not state.model:
        scores = score_candidates(model, state.sensitivities, task.options)
        watch.stop("scores")
    return replace(
        state, stage="finished", model=model, accepted=kept, scores=scores, seconds=watch.seconds
    )


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
    tell_lost(left, (s.candidate for s in alone))
    return kept + common + alone


class _Watch:
    """Wall time by kind of work [s], added to what was measured before."""

    def __init__(self, before: Mapping[str, float] | None = None) -> None:
        self.seconds = dict(before or {})
        self.last = time.perf_counter()

    def stop(self, work: str) -> None:
        now = time.perf_counter()
        self.seconds[work] = self.seconds.get(work, 0.0) + now - self.last
        self.last = now
