"""A line at least every ten seconds while a program computes, with the stage and the time left.

A computation tells its stages and their steps (`identification.runtime.progress`). Where nothing
else was said for a while, this says which stage it is, how far, and how long the rest will take;
where the number of steps is not known beforehand, only how many were done. Of a search the text of
the whole comes first: its stages have a number, and a forecast of the rest.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field

from identification.runtime.progress import Advance, Watch, Whole, duration

EVERY = 10.0  # [s] after which a line is said


@dataclass
class Stage:
    """A stage that is at work."""

    what: str  # its steps are
    steps: int | None  # how many; None where that is not known beforehand
    begun: float  # when [s]
    done: int = 0  # steps that were done

    def line(self, now: float) -> str:
        """Returns how far it is, and how long it will still take where that can be told."""
        said = self.what
        if self.steps is None or self.done > self.steps:
            return f"{said}: {self.done} done" if self.done else said
        said += f": {self.done} of {self.steps}"
        if not self.done:
            return said
        left = (now - self.begun) / self.done * (self.steps - self.done)
        return f"{said}, about {duration(left)} left"


@dataclass
class Beat:
    """Says where a computation is when nothing was said for a while."""

    say: Callable[[str], None]  # writes a line; it may call `told`
    clock: Callable[[], float] = time.monotonic  # the time [s]
    stages: list[Stage] = field(default_factory=list, init=False)  # at work, the innermost one last
    whole: Whole | None = field(default=None, init=False)  # computation of several stages, if any
    # whether a stage has begun or a line was said elsewhere; before that it is silent
    is_heard: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        self.begun = self.last = self.clock()  # of the program, and of the last line [s]

    def told(self) -> None:
        """Notes that a line was said elsewhere."""
        self.last, self.is_heard = self.clock(), True

    def follow(self, whole: Whole | None) -> None:
        """Begins or ends a computation of several stages."""
        self.whole = whole

    @contextmanager
    def stage(self, what: str, steps: int | None, show: Watch | None = None) -> Iterator[Advance]:
        """Begins a stage, shown by a bar too where there is one."""
        self.is_heard = True
        mine = Stage(what, steps, self.clock())
        self.stages.append(mine)
        with nullcontext(lambda: None) if show is None else show(what, steps) as shown:

            def advance() -> None:
                mine.done += 1
                shown()

            try:
                yield advance
            finally:
                self.stages.remove(mine)

    def check(self) -> None:
        """Says a line where none was said for a while."""
        now, stages = self.clock(), [*self.stages]
        if now - self.last < EVERY or not self.is_heard:
            return
        each = [str(self.whole)] if self.whole is not None else []
        each += [stages[-1].line(now)] if stages else []
        where = "; ".join(each) or "still at work"
        self.last = now
        self.say(f"{duration(now - self.begun)}: {where}")


BEATS: list[Beat] = []  # of the running program


def told() -> None:
    """Tells the running program that a line was said."""
    for beat in BEATS:
        beat.told()


@contextmanager
def beating(beat: Beat) -> Iterator[Beat]:
    """Lets a beat look every second, in the block."""
    end = threading.Event()

    def look() -> None:
        while not end.wait(1.0):
            beat.check()

    thread = threading.Thread(target=look, name="beat", daemon=True)
    BEATS.append(beat)
    thread.start()
    try:
        yield beat
    finally:
        end.set()
        BEATS.remove(beat)
