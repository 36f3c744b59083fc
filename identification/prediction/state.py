"""The search by predictions over a horizon: its state, and the moves that it is asked.

fit the nominal model  ->  score all candidates  ->  refit the best  ->  predict unseen records
                                   ^_____________________________________________|   again, with it
then drop effects and places, and what a curve of the data does
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt, collected
from identification.discovery.moves import Move, SearchState, Watch, asked_anew
from identification.discovery.moves import next_state as next_of
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
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
class WindowSearch(SearchState):
    """A search by predictions over a horizon; its effects are `Contender`s.

    Attributes:
        begun: errors of the values with which the fit began, on the records that confirm; over the
            horizon alone where that refutes them.
        worse_fit: errors of the fitted values on the records that confirm, where they are worse
            than those of the values with which the fit began: the search then begins with the
            latter. None where they are not.
        exchanged: the model with the roles of the records exchanged; None where it was not needed.
    """

    begun: Unseen
    worse_fit: Unseen | None = None
    exchanged: WindowModel | None = None

    @property
    def room(self) -> int:
        """How many effects more may be named."""
        options = self.task.options
        return int(min(options.max_effects, options.max_horizon_effects)) - len(self.accepted)


def first_state(task: RecordsTask, progress: Progress) -> WindowSearch:
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
    if refuted is None and uses(task.options, "values_of_start"):
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
    state = WindowSearch(
        task=task, moves=(), begun=begun, nominal=nominal, nominal_scores=scores,
        model=nominal, accepted=(), scores=scores, rejected=(),
        seconds=watch.seconds, worse_fit=worse, failed=tuple(failed),
    )  # fmt: skip
    return replace(state, moves=asked_anew(state, MOVES))


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


def next_state(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state after one more move, as `identification.discovery.moves.next_state`."""
    return next_of(state, MOVES, progress)


def add_effect(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with the best effect that unseen records prove, or what was refitted."""
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


Change = tuple[WindowModel, tuple[Contender, ...], tuple[Contender, ...]]


def _finishing(
    change: Callable[[WindowSearch, Progress], Change],
) -> Callable[[WindowSearch, Progress], WindowSearch]:
    """Returns the move that a change makes: its model, its effects, and those that it lost."""

    def make(state: WindowSearch, progress: Progress) -> WindowSearch:
        watch = Watch(state.seconds)
        model, accepted, lost = change(state, progress)
        watch.stop("refits")
        return replace(
            state, model=model, accepted=accepted, rejected=(*lost, *state.rejected),
            seconds=watch.seconds,
        )  # fmt: skip

    make.__doc__ = change.__doc__
    return make


@_finishing
def drop_effects(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state without effects that later ones have made needless."""
    return prune(state.model, state.accepted, *_rest(state), progress)


@_finishing
def drop_places(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state without places at which an effect that has several does nothing."""
    return without_idle_places(state.model, state.accepted, *_rest(state), progress)


@_finishing
def curve_for_laws(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state with one curve of the data in the place of several laws at a joint."""
    base, confirm, options = _rest(state)
    return with_one_curve(
        state.model, state.accepted, base, state.task.effects, confirm, options, progress
    )


@_finishing
def drop_beside_curves(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state without laws that were found only beside a curve of the data."""
    base, confirm, _ = _rest(state)
    return without_laws_beside_curves(state.model, state.accepted, base, confirm, progress)


@_finishing
def drop_drawn_laws(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state without laws whose work a later curve of the data does."""
    base, confirm, _ = _rest(state)
    return without_drawn_laws(state.model, state.accepted, base, confirm, progress)


MOVES = (
    Move("add_effect", add_effect, grows=True),
    Move("drop_effects", drop_effects),
    Move("drop_places", drop_places),
    Move("curve_for_laws", curve_for_laws),
    Move("drop_beside_curves", drop_beside_curves),
    Move("drop_drawn_laws", drop_drawn_laws),
)


def _rest(state: WindowSearch) -> tuple[NominalModel, list[Record], DiscoveryOptions]:
    """Returns what each of the moves that finish a search is told of the task."""
    task = state.task
    return task.nominal_model, task.confirm, task.options


def rise(begun: Unseen, fitted: Unseen) -> float:
    """Returns the relative rise of the mean square at the horizon from before a fit to after it."""
    before, after = (float(np.mean(np.concatenate(u.at_horizon))) for u in (begun, fitted))
    return after / before - 1
