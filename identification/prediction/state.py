"""The state of a discovery by prediction, and its steps.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  predict unseen records
                                   ^_____________________________________________|   again, with it
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from identification.discovery.attempts import Failed, attempt, collected
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Effect
from identification.errors import InputError
from identification.estimation.options import Progress
from identification.prediction.beside_curves import without_laws_beside_curves
from identification.prediction.blocks import count_blocks
from identification.prediction.drawn_laws import without_drawn_laws
from identification.prediction.exchange import exchanged, without_contradicted
from identification.prediction.extension import with_fitting_steps
from identification.prediction.idle_places import without_idle_places
from identification.prediction.model import WindowModel
from identification.prediction.nominal_fit import as_begun, fit_nominal
from identification.prediction.one_curve import with_one_curve
from identification.prediction.proof import find_doubt
from identification.prediction.records import Record
from identification.prediction.rivals import find_rivals, prune
from identification.prediction.scores import WindowScore
from identification.prediction.screening import score_all
from identification.prediction.selection import (
    Contender,
    refit_contenders,
)
from identification.prediction.unseen import HORIZON, Unseen, compare, predict

FEWEST_BLOCKS = 3  # of unseen windows, whose scatter is known


@dataclass(frozen=True, kw_only=True)
class RecordsTask:
    """The task of a discovery.

    Attributes:
        nominal_model: the model with every candidate effect compiled in, and its free parameters.
        horizon: over which records are predicted [s].
        records: to fit and to confirm.
        effects: the candidates.
        options: all judgement constants.
    """

    nominal_model: NominalModel
    horizon: float
    records: tuple[Record, ...]
    effects: tuple[Effect, ...]
    options: DiscoveryOptions

    @property
    def confirm(self) -> list[Record]:
        """Records that no fit may see."""
        return [r for r in self.records if r.role == "confirm"]


@dataclass(frozen=True, kw_only=True)
class RecordsState:
    """All that a search knows after a step.

    Attributes:
        task: what is asked.
        is_finished: whether there is nothing left to try.
        begun: errors of the values with which the fit began, on the records that confirm; over the
            horizon alone where that refutes them.
        nominal: the fitted model without effects.
        nominal_scores: of all candidates on it, the best first.
        model: the fitted model with the accepted effects.
        accepted: the effects with the models in which they were accepted, in that order.
        alternatives: what else was refitted in the place of each.
        scores: of the candidates that the model lacks, the best first.
        rejected: what the last round refitted and did not accept, the best first.
        seconds: wall time by kind of work [s].
        worse_fit: errors of the fitted values on the records that confirm, where they are worse
            than those of the values with which the fit began: the search then begins with the
            latter. None where they are not.
        exchanged: the model with the roles of the records exchanged; None where it was not needed.
        failed: what was tried and could not be evaluated.
    """

    task: RecordsTask
    is_finished: bool
    begun: Unseen
    nominal: WindowModel
    nominal_scores: tuple[WindowScore, ...]
    model: WindowModel
    accepted: tuple[Contender, ...]
    alternatives: tuple[tuple[Contender, ...], ...]
    scores: tuple[WindowScore, ...]
    rejected: tuple[Contender, ...]
    seconds: Mapping[str, float]
    worse_fit: Unseen | None = None
    exchanged: WindowModel | None = None
    failed: tuple[Failed, ...] = ()


def first_state(task: RecordsTask, progress: Progress) -> RecordsState:
    """Returns the state after the nominal fit, with all candidates scored.

    Args:
        task: what is asked.
        progress: is told a line per step.

    Raises:
        InputError: windows do not fit a record.
        DivergenceError: the nominal model cannot be simulated.
    """
    watch = Watch()
    base = task.nominal_model
    nominal = fit_nominal(base, task.records, progress)
    _refuse_few(nominal.unseen, task.horizon)
    begun = predict(nominal.plant, task.confirm, task.horizon, nominal.scale, {}, nominal.unseen,
                    lengths=HORIZON)  # fmt: skip
    worse, refuted = None, find_doubt(compare(nominal.unseen, begun), 1, task.options)
    if refuted is None:  # over the other lengths too?
        begun = predict(nominal.plant, task.confirm, task.horizon, nominal.scale, {},
                        nominal.unseen)  # fmt: skip
        refuted = find_doubt(compare(nominal.unseen, begun), 1, task.options)
    if refuted is None:
        worse = nominal.unseen
        progress(
            "the fitted values predict unseen records worse (mean square"
            f" {100 * rise(begun, worse):+z.0f} %) than those with which the fit began: these are"
            " kept"
        )
        nominal = as_begun(base, nominal, begun)
    watch.stop("nominal fit")
    with collected(progress) as failed:
        scores = score_all(nominal, task.effects, task.options)
    watch.stop("scores")
    if scores:
        progress(f"{len(scores)} candidates scored, {scores[0].candidate.effect.name} first")
    return RecordsState(
        task=task, is_finished=False, begun=begun, nominal=nominal, nominal_scores=scores,
        model=nominal, accepted=(), alternatives=(), scores=scores, rejected=(),
        seconds=watch.seconds, worse_fit=worse, failed=tuple(failed),
    )  # fmt: skip


def _refuse_few(unseen: Unseen, horizon: float) -> None:
    """Refuse records that confirm and hold too few windows to prove or to deny anything.

    Raises:
        InputError: they do.
    """
    windows = [len(s) for s in unseen.at_horizon]
    if sum(map(count_blocks, windows)) < FEWEST_BLOCKS:
        raise InputError(
            f"the records that confirm hold {sum(windows)} windows of {horizon:g} s, too few to"
            f" prove anything; give at least {2 * FEWEST_BLOCKS} windows, by longer records or a"
            " shorter horizon"
        )


def next_state(state: RecordsState, progress: Progress) -> RecordsState:
    """Returns the state after one more round; a finished state stays as it is.

    A round that fails is told and ends the search: what was found before it stands.

    Args:
        state: the state before.
        progress: is told a line per refit.
    """
    if state.is_finished:
        return state
    with collected(progress, state.failed) as failed:
        new = attempt("the next round", partial(_round, state, progress))
    return replace(new or replace(state, is_finished=True), failed=tuple(failed))


def _round(state: RecordsState, progress: Progress) -> RecordsState:
    """Returns the state after a round."""
    task, watch = state.task, Watch(state.seconds)
    parent, tried = refit_contenders(
        state.model, state.scores, task.horizon, task.confirm, task.options, progress,
        None if state.accepted else state.worse_fit,
    )  # fmt: skip
    nominal = state.nominal if state.accepted else parent
    state = replace(state, model=parent, nominal=nominal)
    model = None
    while model is None:  # a model that its own steps let diverge is none: the next one is asked
        tried, other_side = _checked(state, tried, progress)
        if not tried or not tried[0].is_proven:
            state = replace(state, rejected=tried)
            state = attempt("the pruning", partial(_pruned, state, progress)) or state
            watch.stop("refits")
            return replace(state, is_finished=True, seconds=watch.seconds)
        best = tried[0]
        shorter = partial(with_fitting_steps, best.model, task.horizon, task.confirm)
        model = attempt(best.candidate, shorter)
        tried = tried if model else tried[1:]
    watch.stop("refits")
    scores = score_all(model, task.effects, task.options)
    others = find_rivals(tried[1:], state.model, state.scores, best.model, scores, task.options)
    watch.stop("scores")
    accepted = (*state.accepted, best)
    is_last = len(accepted) >= min(task.options.max_effects, task.options.max_horizon_effects)
    state = replace(
        state, is_finished=is_last, model=model,
        accepted=accepted, alternatives=(*state.alternatives, others), scores=scores, rejected=(),
        seconds=watch.seconds, exchanged=other_side,
    )  # fmt: skip
    if not is_last:
        return state
    return attempt("the pruning", partial(_pruned, state, progress)) or state


def _checked(
    state: RecordsState, tried: tuple[Contender, ...], progress: Progress
) -> tuple[tuple[Contender, ...], WindowModel | None]:
    """Returns contenders, contradicted ones unproven, and the first one with roles exchanged.

    Where the search began at values that no fit found, there is nothing to exchange.
    """
    task = state.task
    begun_elsewhere = state.worse_fit is not None and not state.accepted
    if begun_elsewhere or not tried or not tried[0].is_proven:
        return tried, None
    without = state.exchanged or exchanged(state.model, task.records, task.horizon)
    if without is None:
        return tried, None
    return without_contradicted(tried, without, task.records, task.horizon, task.options, progress)


def _pruned(state: RecordsState, progress: Progress) -> RecordsState:
    """Returns the state without needless effects, and without laws that a curve may have left."""
    task = state.task
    rest = task.nominal_model, task.confirm, task.options, progress
    model, keep = prune(state.model, state.accepted, *rest)
    model, accepted = without_idle_places(model, [state.accepted[k] for k in keep], *rest)
    others = {a.candidate.key: state.alternatives[k] for a, k in zip(accepted, keep, strict=True)}
    base, confirm = task.nominal_model, task.confirm
    model, accepted, several = with_one_curve(model, accepted, base, task.effects, *rest[1:])
    model, accepted, lost = without_laws_beside_curves(model, accepted, base, confirm, progress)
    model, accepted, drawn = without_drawn_laws(model, accepted, *rest)
    return replace(
        state, model=model, accepted=accepted, rejected=(*several, *drawn, *lost, *state.rejected),
        alternatives=tuple(others.get(a.candidate.key, ()) for a in accepted),
    )  # fmt: skip


def rise(begun: Unseen, fitted: Unseen) -> float:
    """Returns the relative rise of the mean square at the horizon from before a fit to after it."""
    before, after = (float(np.mean(np.concatenate(u.at_horizon))) for u in (begun, fitted))
    return after / before - 1


class Watch:
    """Wall time by kind of work [s], added to what was measured before."""

    def __init__(self, before: Mapping[str, float] | None = None) -> None:
        self.seconds = dict(before or {})
        self.last = time.perf_counter()

    def stop(self, work: str) -> None:
        """Count the time since the last stop as this kind of work."""
        now = time.perf_counter()
        self.seconds[work] = self.seconds.get(work, 0.0) + now - self.last
        self.last = now
