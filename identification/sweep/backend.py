"""The seam between a sweep and the machines: a backend takes tasks and yields outcomes.

A backend holds few tasks at a time, so that memory does not grow with their number, and it may
yield outcomes in any order. It has no queue of its own: `concurrent.futures`, Dask and Slurm have.
Those of this machine stand here. A worker process ends when this process does, also where that is
killed: it watches its parent.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from itertools import islice
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.connection import wait as wait_for
from typing import Protocol

from identification.errors import InputError
from identification.sweep.task import Task
from identification.sweep.work import Outcome, one_thread

WINDOW = 3  # tasks that wait or run, for each worker
Work = Callable[[Task], Outcome]


class Backend(Protocol):
    """Runs tasks somewhere."""

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in the order in which they end.

        Args:
            work: a function of a module, which a worker can import.
            tasks: asked for one by one, as there is room.

        Raises:
            InputError: workers cannot be had, or died; what was yielded before is right.
        """
        ...


class LostWorkers(InputError):
    """Workers died or cannot be reached; a sweep is resumed with what it has."""


class Serial:
    """Runs tasks one after the other in this process."""

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in their order."""
        return map(work, tasks)


@dataclass(frozen=True)
class Processes:
    """Processes of this machine."""

    jobs: int  # how many

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in the order in which they end."""
        waiting = iter(tasks)
        others = set(active_children())
        pool = ProcessPoolExecutor(self.jobs, get_context("spawn"), initializer=_begin)
        try:
            with one_thread():  # the processes begin here
                futures = {pool.submit(work, t) for t in islice(waiting, WINDOW * self.jobs)}
            while futures:
                ended, futures = wait(futures, return_when=FIRST_COMPLETED)
                futures |= {pool.submit(work, t) for t in islice(waiting, len(ended))}
                for future in ended:
                    yield future.result()
        except BrokenProcessPool as error:
            raise LostWorkers(
                "a worker process died, killed by a signal or for want of memory; the records that"
                " were written are kept: run the same command with --resume, or fewer --jobs"
            ) from error
        except MemoryError as error:
            raise LostWorkers(
                "a worker has too little memory; run the same command with --resume and fewer"
                " --jobs: the records that were written are kept"
            ) from error
        finally:
            for child in set(active_children()) - others:  # also in the middle of a task
                child.terminate()
            pool.shutdown(wait=False, cancel_futures=True)


def _begin() -> None:
    """Leave Ctrl-C to the parent, and end with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def end() -> None:
        if parent is not None:
            wait_for([parent.sentinel])
            os._exit(1)

    threading.Thread(target=end, daemon=True).start()
