"""Progress of a long computation: told where it is known, shown by whoever watches.

A computation tells the stage it is in and counts its steps. Nothing is shown unless a program
watches, as the commands do. A search does not know how many steps it will take, and gives no
number; a bar then has a usual one, and grows where it takes more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from typing import TypeVar

USUAL = 15  # steps of a search
Item = TypeVar("Item")
Advance = Callable[[], None]
Progress = Callable[[str], None]  # is told one line after each step
Watch = Callable[[str, int | None], AbstractContextManager[Advance]]  # of a stage and its steps

_WATCH: ContextVar[Watch | None] = ContextVar("watch", default=None)


@contextmanager
def watched(watch: Watch) -> Iterator[None]:
    """Show the stages of what is computed in the block."""
    token = _WATCH.set(watch)
    try:
        yield
    finally:
        _WATCH.reset(token)


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
