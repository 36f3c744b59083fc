"""Tasks on many machines: Dask, and jobs of Slurm by submitit.

Dask runs on this machine's processes, or at a scheduler that runs somewhere. It gives the task of a
worker that died to another one, at most `allowed-failures` times (its configuration
`distributed.scheduler.allowed-failures`, 3 if nobody changed it).

The local executor of submitit runs the same jobs as processes. Where Slurm stops a job for its time
or to give its place to another, submitit puts the job into the queue again with what `checkpoint`
returns: the tasks that are left, and the outcomes so far.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from shutil import rmtree
from typing import Any
from uuid import uuid4

from identification.errors import InputError
from identification.runtime.lazy import needed
from identification.sweep.backend import WINDOW, LostWorkers, Work
from identification.sweep.task import Task
from identification.sweep.work import Outcome, one_thread

WAIT = 15  # [s] for a scheduler, and for its first worker


@dataclass(frozen=True)
class Dask:
    """A Dask cluster."""

    address: str | None  # of a running scheduler; None for a cluster of this machine's processes
    jobs: int  # processes of such a cluster

    def __post_init__(self) -> None:
        needed("distributed", "cluster", "--backend dask")

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in the order in which they end."""
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


POLL = 0.2  # [s] between two looks at local jobs; of Slurm submitit asks less often
TASKS = "tasks_per_job"  # our own option beside those of submitit


@dataclass
class Chunk:
    """Some tasks that one job runs, and the outcomes of those that have ended."""

    work: Work  # runs a task
    tasks: list[Task]  # in their order
    done: list[Outcome] = field(default_factory=list)  # outcomes of the first of them

    def __call__(self) -> list[Outcome]:
        """Run what is left."""
        for task in self.tasks[len(self.done) :]:
            self.done.append(self.work(task))
        return self.done

    def checkpoint(self) -> Any:
        """Returns what submitit puts into the queue in place of a job that is stopped."""
        import submitit

        return submitit.helpers.DelayedSubmission(self)


@dataclass(frozen=True)
class Submitit:
    """Jobs of submitit."""

    cluster: str  # "slurm" or "local"
    jobs: int  # how many are in the queue or run at a time
    folder: Path  # for what they say; all machines must see it
    # of submitit by name, such as slurm_partition or timeout_min; and `tasks_per_job`
    options: dict[str, str]

    def __post_init__(self) -> None:
        needed("submitit", "cluster", f"--backend {self.cluster}")

    def outcomes(self, work: Work, tasks: Iterable[Task]) -> Iterator[Outcome]:
        """Yields the outcome of each task, in the order in which their jobs end."""
        import submitit

        executor, size = self._executor()
        waiting = iter(tasks)

        def chunks(count: int) -> list[Any]:
            made = (Chunk(work, some) for _ in range(count) if (some := [*islice(waiting, size)]))
            try:
                with one_thread():  # the jobs have our environment
                    return [executor.submit(chunk) for chunk in made]
            except submitit.core.utils.FailedJobError as error:
                raise LostWorkers(
                    f"{self.cluster} took no job: {_last_line(error)}; {self._correct}, or see with"
                    " `sinfo` which partitions there are and whether Slurm answers; the records"
                    " that were written are kept: run the same command with --resume"
                ) from error

        jobs: list[Any] = []
        poll = POLL if self.cluster == "local" else 10
        try:
            jobs = chunks(self.jobs)
            while jobs:
                job = next(submitit.helpers.as_completed(jobs, poll_frequency=poll))
                jobs.remove(job)
                outcomes = job.result()
                jobs += chunks(1)
                yield from outcomes
        except (submitit.core.utils.FailedJobError, submitit.core.utils.UncompletedJobError) as e:
            raise LostWorkers(
                f"a job failed, and what it said is in {self.folder}: {_last_line(e)}; where Slurm"
                " ended it for its time or its memory, give it more with --job (timeout_min,"
                " mem_gb); the records that were written are kept: run the same command with"
                " --resume"
            ) from e
        finally:
            for job in jobs:
                job.cancel(check=False)
        rmtree(self.folder, ignore_errors=True)

    @property
    def _correct(self) -> str:
        """Advice where a job is refused: the options that were given, or could be."""
        given = " ".join(f"{name}={value}" for name, value in self.options.items())
        if given:
            return f"correct the options that --job gives ({given})"
        return "give the options that it wants with --job, such as slurm_partition=long"

    def _executor(self) -> tuple[Any, int]:
        import submitit

        given: dict[str, Any] = {name: _number(text) for name, text in self.options.items()}
        size = given.pop(TASKS, 1)
        if not isinstance(size, int) or size < 1:
            raise InputError(f"--job {TASKS}={size}: give a whole number, 1 or more")
        try:
            executor = submitit.AutoExecutor(folder=self.folder, cluster=self.cluster)
            executor.update_parameters(**{"timeout_min": 60, "cpus_per_task": 1, **given})
        except (RuntimeError, NameError, AssertionError, TypeError, OSError) as error:
            raise InputError(
                f"submitit cannot submit to {self.cluster}: {' '.join(str(error).split())};"
                f" {self._correct}, or choose another --backend"
            ) from error
        return executor, size


def _number(text: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _last_line(error: Exception) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[-1] if lines else type(error).__name__
