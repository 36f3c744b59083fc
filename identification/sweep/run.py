"""Runs the tasks of a sweep that have no record yet, and keeps each record as its task ends."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from identification.errors import InputError
from identification.progress import duration, stage
from identification.sweep.backends.backend import Backend
from identification.sweep.rows import row
from identification.sweep.store import Store
from identification.sweep.work import work

EVERY = 15.0  # [s] between two lines of progress


def run_sweep(
    store: Store,
    backend: Backend,
    *,
    resume: bool = False,
    progress: Callable[[str], None] | None = None,
) -> int:
    """Run what is not done; returns how many tasks were run.

    Args:
        store: the records, open.
        backend: where the tasks run.
        resume: go on with records that are there; without it they are refused.
        progress: is told a line now and then, with the time that is left.

    Raises:
        InputError: records are there and `resume` is False, or workers died; every record that
            was written is kept.
    """
    sweep, done = store.sweep, len(store.done)
    if done and not resume:
        raise InputError(
            f"{store.records} holds {done} of {len(sweep)} records of this sweep; write --resume to"
            " go on with them, or give --out a new folder"
        )
    before = frozenset(store.done)  # the other changes as records come
    todo = (number for number in range(len(sweep)) if number not in before)
    clock = _Clock(len(sweep) - done)
    if not clock.total:
        return 0  # no cluster is started for nothing
    with stage("tasks", clock.total) as advance:
        for outcome in backend.outcomes(work, map(sweep.task, todo)):
            store.add(row(sweep, outcome))
            advance()
            line = clock.count(outcome.error is not None)
            if line and progress is not None:
                progress(line)
    return clock.ended


@dataclass
class _Clock:
    """Counts tasks, and says now and then how long the rest will take."""

    total: int
    ended: int = 0
    failed: int = 0

    def __post_init__(self) -> None:
        self.begun = self.said = time.monotonic()

    def count(self, failed: bool) -> str:
        """Counts one more task; returns a line if it is time for one, else ""."""
        self.ended += 1
        self.failed += failed
        now = time.monotonic()
        if now - self.said < EVERY and self.ended < self.total:
            return ""
        self.said = now
        left = (now - self.begun) / self.ended * (self.total - self.ended)
        errors = f", {self.failed} with an error" if self.failed else ""
        return f"{self.ended} of {self.total} tasks{errors}, {duration(left)} left"
