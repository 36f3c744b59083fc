"""A search is a list of moves: each is asked for a better model, until none is left to ask.

    growing moves     the first that adds an effect is taken, and all of them are asked again
    finishing moves   once none adds an effect, or there is room for no more, each is asked once

The two kinds of evidence (the innovations of a free run, predictions over a horizon) have moves of
their own, and search in this one loop.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Generic, TypeVar

from identification.discovery.attempts import Failed, attempt, collected
from identification.progress import Progress


@dataclass(frozen=True, kw_only=True)
class SearchState:
    """All that a search knows after a step; each kind of evidence adds what it needs.

    Attributes:
        task: what is asked.
        moves: those that are still to be asked, in their order; none of a finished search.
        nominal: the fitted model without effects.
        nominal_scores: of all candidates on the nominal fit, the best first.
        model: the fitted model with the accepted effects.
        accepted: the effects that were accepted, in that order.
        scores: of the candidates that the model does not have, on it, the best first.
        rejected: what the last round refitted and did not accept, the best first.
        seconds: wall time by kind of work [s].
        failed: what was tried and could not be evaluated.
        made: names of the moves that changed the effects, in their order.
    """

    task: Any
    moves: tuple[Move[Any], ...]
    nominal: Any
    nominal_scores: tuple[Any, ...]
    model: Any
    accepted: tuple[Any, ...]
    scores: tuple[Any, ...]
    rejected: tuple[Any, ...]
    seconds: Mapping[str, float]
    failed: tuple[Failed, ...] = ()
    made: tuple[str, ...] = ()

    @property
    def is_finished(self) -> bool:
        """Whether there is nothing left to ask."""
        return not self.moves

    @property
    def room(self) -> int:
        """How many effects more may be named."""
        return int(self.task.options.max_effects) - len(self.accepted)


State = TypeVar("State", bound=SearchState)


@dataclass(frozen=True)
class Move(Generic[State]):
    """A way to a better model.

    Attributes:
        name: by which options leave it out, of `identification.discovery.passes`. The move that
            adds an effect is the search itself, and no option leaves it out.
        make: returns the state after it; the state itself where it finds nothing better.
        grows: whether it adds effects.
    """

    name: str
    make: Callable[[State, Progress], State]
    grows: bool = False

    def __str__(self) -> str:
        return self.name.replace("_", " ")


def asked_anew(state: State, every: Sequence[Move[State]]) -> tuple[Move[State], ...]:
    """Returns the moves that are to be asked of a model with one more effect, or with none.

    Args:
        state: with its model and its options.
        every: all moves of this kind of evidence, in their order.
    """
    used = [m for m in every if m.name not in state.task.options.without]
    return tuple(m for m in used if not m.grows or state.room > 0)


def next_state(state: State, every: Sequence[Move[State]], progress: Progress) -> State:
    """Returns the state after one more move; a finished state stays as it is.

    A move that fails is told and skipped: what was found before it stands.

    Args:
        state: the state before.
        every: all moves of this kind of evidence, in their order.
        progress: is told a line per refit.
    """
    if state.is_finished:
        return state
    move, *rest = state.moves
    with collected(progress, state.failed) as failed:
        new = attempt(f"the move {move}", partial(move.make, state, progress)) or state
    new = replace(new, failed=tuple(failed))
    if [*map(id, new.accepted)] != [*map(id, state.accepted)]:
        new = replace(new, made=(*new.made, move.name))
    grown = len(new.accepted) > len(state.accepted)
    return replace(new, moves=asked_anew(new, every) if grown else tuple(rest))


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
