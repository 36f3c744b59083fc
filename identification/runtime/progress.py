"""Progress of a long computation: told where it is known, shown by whoever watches.

A computation tells what it is at and counts its steps. Nothing is shown unless a program
watches, as the commands do. A search does not know how many steps it will take, and gives no
number; a bar then has a usual one, and grows where it takes more. What has several stages tells
where it is among them, too (`following`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from typing import Protocol, TypeVar

USUAL = 15  # steps of a search
Item = TypeVar("Item")
Advance = Callable[[], None]
Progress = Callable[[str], None]  # is told one line after each step
Watch = Callable[[str, int | None], AbstractContextManager[Advance]]  # of a stage and its steps


class Whole(Protocol):
    """A computation of several stages: where it is now is its text."""

    def enter(self, stage: str) -> None:
        """Begins a stage."""


Follow = Callable[[Whole | None], object]  # is given what is computed, and None at its end
_WATCH: ContextVar[Watch | None] = ContextVar("watch", default=None)
_FOLLOW: ContextVar[Follow | None] = ContextVar("follow", default=None)
_WHOLE: ContextVar[Whole | None] = ContextVar("whole", default=None)


@contextmanager
def watched(watch: Watch, follow: Follow | None = None) -> Iterator[None]:
    """Show the stages of what is computed in the block."""
    token, other = _WATCH.set(watch), _FOLLOW.set(follow)
    try:
        yield
    finally:
        _WATCH.reset(token)
        _FOLLOW.reset(other)


@contextmanager
def following(whole: Whole) -> Iterator[None]:
    """Tells whoever watches, in the block, among which stages the computation is."""
    token, follow = _WHOLE.set(whole), _FOLLOW.get() or _nobody
    follow(whole)
    try:
        yield
    finally:
        follow(None)
        _WHOLE.reset(token)


def enter(stage: str) -> None:
    """Begins a stage of the computation that is followed; does nothing where none is."""
    if (whole := _WHOLE.get()) is not None:
        whole.enter(stage)


def _nobody(whole: Whole | None) -> None:
    """Ignores what is followed."""


@contextmanager
def stage(what: str, steps: int | None = None) -> Iterator[Advance]:
    """Begins a stage of a computation; call what it yields after each step.

    Args:
        what: its steps are.
        steps: how many; None where that is not known beforehand.
    """
    watch = _WATCH.get()
    if watch is None:
        yield lambda: None
        return
    with watch(what, steps) as advance:
        yield advance


def counted(items: Iterable[Item], what: str, steps: int | None = None) -> Iterator[Item]:
    """Yields the items of a stage, each counted when the next one is asked for."""
    with stage(what, steps) as advance:
        for item in items:
            yield item
            advance()


def duration(seconds: float) -> str:
    """Returns a time as a person says it: 40 s, 12 min, 3 h 5 min."""
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 2:
        return f"{60 * minutes + rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min"
