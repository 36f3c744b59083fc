"""Runs the tasks of a sweep that have no record yet, and keeps each record as its task ends."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from identification.errors import InputError, unknown_name
from identification.runtime.progress import duration, stage
from identification.sweep.backend import Backend, Processes, Serial
from identification.sweep.rows import row
from identification.sweep.store import Store
from identification.sweep.work import work

BACKENDS = ("processes", "serial", "dask", "slurm", "submitit-local")
_ADDRESSES = ("tcp://", "tls://", "dask://")
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


def backend_of(
    word: str, jobs: int | None, folder: Path, options: Mapping[str, str] | None = None
) -> Backend:
    """Returns a backend by its word.

    Args:
        word: one of `BACKENDS`, or the address of a running Dask scheduler.
        jobs: workers, or jobs of Slurm at a time; as many as processors when None.
        folder: of the sweep, where Slurm's jobs leave what they say.
        options: of Slurm's jobs, as submitit names them.

    Raises:
        InputError: there is no such backend, its package is not installed, or a number is bad.
    """
    if jobs is not None and jobs < 1:
        raise InputError(f"--jobs {jobs}: give 1 or more")
    is_address = word.startswith(_ADDRESSES)
    if not is_address and word not in BACKENDS:
        error = unknown_name("backend", word, BACKENDS)
        raise InputError(f"{error}; or the address of a Dask scheduler, such as tcp://HOST:8786")
    if options and word not in ("slurm", "submitit-local"):
        raise InputError(f"--job is for --backend slurm, and the backend is {word}; leave it out")
    allowed = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else ()
    count = jobs or len(allowed) or os.cpu_count() or 1
    if word == "processes":
        return Processes(count)
    if word == "serial":
        return Serial()
    if word == "dask" or is_address:
        from identification.sweep.clusters import Dask

        return Dask(word.replace("dask://", "tcp://") if is_address else None, count)
    from identification.sweep.clusters import Submitit

    cluster = "local" if word == "submitit-local" else "slurm"
    return Submitit(cluster, count, folder / ".jobs", dict(options or {}))


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
        rest = (now - self.begun) / self.ended * (self.total - self.ended)
        errors = f", {self.failed} with an error" if self.failed else ""
        return f"{self.ended} of {self.total} tasks{errors}, {duration(rest)} left"
