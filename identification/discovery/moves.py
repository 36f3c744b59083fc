"""A search is a list of moves: each is asked for a better model, until none is left to ask.

    growing moves     the first that adds an effect is taken, and all moves are asked again
    other moves       each is asked once: those before the growing ones after every new effect, the
                      rest once none adds an effect, or there is room for no more; one that makes
                      room lets all be asked again, once

What tells one model from another is an `Evidence`: the innovations of a free run
(`identification.innovations`), or predictions over a horizon (`identification.prediction`). Each
has moves, and both search in this one loop.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import inf, isfinite
from typing import Any, Generic, Protocol, TypeVar

from identification.discovery.attempts import Failed, attempt, collected
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.outlook import CHECKS, EFFECT, FIT, LEFT, Outlook, Rests
from identification.discovery.result import Discovery
from identification.effects.effect import Candidate, Effect
from identification.runtime.pool import OutOfTime, one_blas_thread, until
from identification.runtime.progress import Progress, following, stage
from identification.shares import times_estimated


@dataclass(frozen=True, kw_only=True)
class Task:
    """The question of a search: what does this model lack? An evidence adds the data."""

    # the model with every candidate effect compiled in, and its free parameters
    nominal_model: NominalModel
    effects: tuple[Effect, ...]  # the candidates
    options: DiscoveryOptions  # all judgement constants


class Trial(Protocol):
    """An effect that was refitted beside those that a model has."""

    @property
    def model(self) -> Any:
        """The model with it, and what speaks for it there."""

    @property
    def candidate(self) -> Candidate:
        """The effect at its place, with its shapes."""


@dataclass(frozen=True, kw_only=True)
class SearchState:
    """All that a search knows after a step; each kind of evidence adds what it needs."""

    task: Any  # what is asked
    # those that are still to be asked, in their order; none of a finished search
    moves: tuple[Move[Any], ...]
    nominal: Any  # the fitted model without effects
    nominal_scores: tuple[Any, ...]  # of all candidates on the nominal fit, the best first
    model: Any  # the fitted model with the accepted effects
    accepted: tuple[Any, ...]  # the effects that were accepted, each a `Trial`, in that order
    scores: tuple[Any, ...]  # of the candidates that the model does not have, on it, the best first
    rejected: tuple[Any, ...]  # what the last round refitted and did not accept, the best first
    seconds: Mapping[str, float]  # wall time by kind of work [s]
    failed: tuple[Failed, ...] = ()  # what was tried and could not be evaluated
    made: tuple[str, ...] = ()  # names of the moves that changed the effects, in their order
    # in seconds of `time.monotonic`: when the search began, None where each step is asked for; and
    # when moves that may take long have to end
    began: float | None = None
    end: float = inf
    cut_short: tuple[str, ...] = ()  # names of the moves that were ended at that time

    @property
    def is_finished(self) -> bool:
        """Tells whether there is nothing left to ask."""
        return not self.moves

    @property
    def took(self) -> float:
        """Returns the wall time of the search up to now [s]; of its kinds of work where stepped."""
        return sum(self.seconds.values()) if self.began is None else time.monotonic() - self.began

    @property
    def room(self) -> int:
        """Returns how many effects more may be named."""
        return int(self.task.options.max_effects) - len(self.accepted)


State = TypeVar("State", bound=SearchState)


@dataclass(frozen=True)
class Move(Generic[State]):
    """A way to a better model."""

    # by which options leave it out, of `identification.discovery.passes`. The move that adds an
    # effect is the search itself, and no option leaves it out.
    name: str
    # returns the state after it; the state itself where it finds nothing better
    make: Callable[[State, Progress], State]
    # whether it adds effects; the time limit of a search ends moves that do
    grows: bool = False

    def __str__(self) -> str:
        return self.name.replace("_", " ")


@dataclass(frozen=True)
class Evidence(Generic[State]):
    """A way to tell one model from another, which alone knows how one is fitted and proven."""

    # returns the state after the nominal fit of a task, with all candidates scored
    first: Callable[[Any, Progress], State]
    moves: tuple[Move[State], ...]  # those that a state is asked, in their order
    conclude: Callable[[State], Discovery]  # returns the outcome of a finished search
    # rms error of a state's model on the unseen data that decide, over that of the sensors
    times_noise: Callable[[State], float] | None = None
    rests: Rests = field(default_factory=dict)  # what is left of a search where a stage begins

    def begin(self, task: Task, progress: Progress) -> State:
        """Returns the state with which a search begins.

        Args:
            task: what is asked.
            progress: is told a line per step.

        Raises:
            InputError: the data do not suffice, or a free parameter has no effect on any output.
            DivergenceError: the nominal model cannot be simulated.
        """
        state = self.first(task, progress)
        return replace(state, moves=self.asked(state))

    def asked(self, state: State) -> tuple[Move[State], ...]:
        """Returns the moves to be asked of a model with one more effect, or with none."""
        used = [m for m in self.moves if m.name not in state.task.options.without]
        return tuple(m for m in used if not m.grows or state.room > 0)

    def step(self, state: State, progress: Progress) -> State:
        """Returns the state after one more move; a finished state stays as it is.

        A move that fails, or that the time limit of the search ends, is told and skipped: what was
        found before it stands.

        Args:
            state: the state before.
            progress: is told a line per refit.
        """
        if state.is_finished:
            return state
        move, *rest = state.moves
        end = state.end if move.grows else inf
        with collected(progress, state.failed) as failed:
            try:
                with until(end):
                    new = attempt(f"the move {move}", partial(move.make, state, progress)) or state
            except OutOfTime:
                progress(f"the move {move}: ended, because the time limit of the search is over")
                new = replace(state, cut_short=(*state.cut_short, move.name))
        new = replace(new, failed=tuple(failed))
        if [*map(id, new.accepted)] != [*map(id, state.accepted)]:
            new = replace(new, made=(*new.made, move.name))
        has_grown = len(new.accepted) > len(state.accepted)
        return replace(new, moves=self.asked(new) if has_grown else tuple(rest))

    @one_blas_thread()
    def search(self, task: Task, progress: Progress | None = None) -> Discovery:
        """Returns what a model lacks, as far as the data tell it.

        Args:
            task: what is asked.
            progress: is told a line per step.

        Raises:
            InputError: as `begin`.
            DivergenceError: as `begin`.
        """
        say = progress or _say_nothing
        outlook = Outlook(say, self.rests)
        began = time.monotonic()
        end = began + 60 * task.options.max_minutes
        with following(outlook):
            outlook.enter(FIT)
            state, asked = replace(self.begin(task, say), began=began, end=end), -1
            while not state.is_finished:
                grown, effects = asked != len(state.accepted), len(state.accepted)
                may_grow = any(m.grows for m in state.moves)
                if may_grow and grown:
                    outlook.enter(EFFECT, effects, self._told(state))
                elif not may_grow and outlook.stage != CHECKS:
                    outlook.enter(CHECKS, effects)
                asked = effects
                state = self.step(state, say)
            outlook.enter(LEFT, len(state.accepted), self._told(state))
            with stage("what is left, and what the data could show"):
                return self.conclude(state)

    def _told(self, state: State) -> str:
        """Returns how far the model of a state is from the data, and what it has, in words."""
        if self.times_noise is None:
            return ""
        ratio = self.times_noise(state)
        far = f"the error on the unseen data that decide is {times_estimated(ratio)}"
        names = [f"{a.candidate.effect.name}, {a.candidate.where}" for a in state.accepted]
        return "; ".join([*([far] if isfinite(ratio) else []),
                          *([f"in the model: {', '.join(names)}"] if names else [])])  # fmt: skip


T = TypeVar("T", bound=Trial)


def drop_needless(
    model: Any, accepted: Sequence[T], without: Callable[[Any, T], Any], progress: Progress
) -> tuple[tuple[T, ...], Any]:
    """Returns the effects that are still needed, and the model with them.

    Args:
        model: with all effects.
        accepted: the effects in the order of their acceptance; the last one was just proven.
        without: returns the refit of a model without one of them; None where it is needed.
        progress: is told a line per effect that is dropped.
    """
    kept = [*accepted]
    for old in accepted[:-1]:
        less = without(model, old)
        if less is not None:
            progress(f"{old.candidate.effect.name}, {old.candidate.where}: no longer needed")
            model, kept = less, [k for k in kept if k is not old]
    return tuple(kept), model


def _say_nothing(line: str) -> None:
    """Ignores a line of progress."""


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
