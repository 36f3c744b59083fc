"""Tasks on Dask: a cluster of this machine's processes, or a scheduler that runs somewhere.

Dask gives the task of a worker that died to another one, at most `allowed-failures` times (its
configuration `distributed.scheduler.allowed-failures`, 3 if nobody changed it).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import islice
from typing import Any
from uuid import uuid4

from identification.sweep.backends.backend import WINDOW, LostWorkers, Work
from identification.sweep.extras import needed
from identification.sweep.task import Task
from identification.sweep.work import Outcome

WAIT = 15  # [s] for a scheduler, and for its first worker


@dataclass(frozen=True)
class Dask:
    """A Dask cluster.

    Attributes:
        address: of a running scheduler; None for a cluster of this machine's processes.
        jobs: processes of such a cluster.
    """

    address: str | None
    jobs: int

    def __post_init__(self) -> None:
        needed("distributed", "cluster", "--backend dask")

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in the order in which they end.

        Raises:
            InputError: the scheduler or a worker cannot be reached, or a task killed its workers.
        """
        import distributed

        waiting, run = iter(tasks), uuid4().hex
        with ExitStack() as stack:
            client = self._client(stack)
            workers = max(self.jobs if self.address is None else 0, len(client.nthreads()))

            def submit(task: Task) -> Any:
                return client.submit(work, task, key=f"sweep-{run}-{task.number}", pure=False)

            first = [submit(task) for task in islice(waiting, WINDOW * workers)]
            ended = distributed.as_completed(first, loop=client.loop)
            del first  # a future that is held keeps its result in a worker
            try:
                for future in ended:
                    outcome = future.result()
                    ended.update([submit(task) for task in islice(waiting, 1)])
                    yield outcome
            except (distributed.KilledWorker, CancelledError, MemoryError, OSError) as error:
                raise LostWorkers(
                    f"Dask gave a task up: {' '.join(str(error).split())}; the records that were"
                    " written are kept: run the same command with --resume"
                ) from error

    def _client(self, stack: ExitStack) -> Any:
        import distributed

        where: Any = self.address
        if where is None:
            where = stack.enter_context(
                distributed.LocalCluster(
                    n_workers=self.jobs, threads_per_worker=1, processes=True,
                    dashboard_address="127.0.0.1:0", host="127.0.0.1",
                )
            )  # fmt: skip
        try:
            client = stack.enter_context(
                distributed.Client(where, timeout=WAIT, set_as_default=False)
            )
            client.wait_for_workers(1, timeout=WAIT)
        except (OSError, TimeoutError) as error:
            raise LostWorkers(
                f"no Dask scheduler with a worker answers at {self.address or 'this machine'};"
                " start dask scheduler and dask worker, and give their address"
            ) from error
        return client
