"""A backend by the word of the command line."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from identification.errors import InputError, unknown_name
from identification.sweep.backends.backend import Backend, Work
from identification.sweep.task import Task
from identification.sweep.work import Outcome

BACKENDS = ("processes", "serial", "dask", "slurm", "submitit-local")
_ADDRESSES = ("tcp://", "tls://", "dask://")


class Serial:
    """Runs tasks one after the other in this process."""

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in their order."""
        return map(work, tasks)


def processors() -> int:
    """Returns how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


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
    count = jobs or processors()
    if word == "processes":
        from identification.sweep.backends.processes import Processes

        return Processes(count)
    if word == "serial":
        return Serial()
    if word == "dask" or is_address:
        from identification.sweep.backends.dask_cluster import Dask

        return Dask(word.replace("dask://", "tcp://") if is_address else None, count)
    from identification.sweep.backends.submitit_jobs import Submitit

    cluster = "local" if word == "submitit-local" else "slurm"
    return Submitit(cluster, count, folder / ".jobs", dict(options or {}))
