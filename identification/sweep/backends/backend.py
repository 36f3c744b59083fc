"""The seam between a sweep and the machines: a backend takes tasks and yields outcomes.

A backend holds few tasks at a time, so that memory does not grow with their number, and it may
yield outcomes in any order. It has no queue of its own: `concurrent.futures`, Dask and Slurm have.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Protocol

from identification.errors import InputError
from identification.sweep.task import Task
from identification.sweep.work import Outcome

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
