"""A worker's part: one task at a time, on one thread, from its data to its outcome.

The sums of a BLAS depend on the number of its threads, in the last bits. So a worker uses one, and
its simulations do too: the tasks beside it have the other processors.
"""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from identification.sweep.method import Column, error_line, load_method
from identification.sweep.settings import build
from identification.sweep.task import Task

HERE = Path(__file__).parent


@cache
def commit() -> str:
    """Returns the commit of the checkout of this file, "-dirty" where files differ from it.

    It is empty where there is no git, or where the file is not one of a checkout.
    """
    try:
        subprocess.run(
            ["git", "ls-files", "--error-unmatch", Path(__file__).name], cwd=HERE,
            capture_output=True, check=True,
        )  # fmt: skip
        said = subprocess.run(
            ["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True,
            check=True,
        )  # fmt: skip
    except (OSError, subprocess.CalledProcessError):
        return ""
    return said.stdout.strip()


@cache
def code() -> str:
    """Returns the version of the package, and its commit in a checkout: "0.2.0, c7d7b26"."""
    return ", ".join(filter(None, (version("inca-mj"), commit())))


THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "INCA_MJ_THREADS")
_ONE = threading.Lock()  # a Dask worker may have several threads; limits hold for the process
_PLAIN: dict[Any, type | tuple[type, ...]] = {
    bool: bool, int: int, float: (int, float), str: str,
}  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """The outcome of a task."""

    number: int  # of the task
    # an entry for each column of its method; None where it met an error
    record: dict[str, Any] | None
    error: str | None  # the kind of the error and its message, in a line; None where there was none
    # how it was computed (seconds, host, ...), which no two runs have in common
    run: dict[str, Any]


def work(task: Task) -> Outcome:
    """Run a task; an error of its method is an outcome too.

    A MemoryError is none: it says nothing about the task.
    """
    import resource

    from threadpoolctl import threadpool_limits

    with _ONE, one_thread():
        begin, processor = time.perf_counter(), time.process_time()
        record, error, trace = None, None, None
        with threadpool_limits(1):
            try:
                method = load_method(task.reference)
                made = method.run(build(method.settings, task.settings), task.seed)
                record = checked(made, method.columns)
            except MemoryError:
                raise
            except (Exception, SystemExit) as caught:
                error = error_line(caught, task.reference)
                trace = traceback.format_exc(limit=-4)
        unit = 1 if sys.platform == "darwin" else 1024  # of the memory, in bytes
        run = {
            "seconds": time.perf_counter() - begin,
            "processor_seconds": time.process_time() - processor,
            "ended": time.time(), "host": socket.gethostname(), "process": os.getpid(),
            "memory": unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, "code": code(),
            "trace": trace,
        }  # fmt: skip
        return Outcome(task.number, record, error, run)


@contextmanager
def one_thread() -> Iterator[None]:
    """Keeps to one thread in the block: libraries loaded there, simulations, and children."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def checked(record: Mapping[str, Any], columns: Mapping[str, Column]) -> dict[str, Any]:
    """Returns a record with plain values of the kinds that its method declares.

    A TypeError tells a fault of the method: an entry that is missing, too many, or of another kind.
    """
    if set(record) != set(columns):
        raise TypeError(
            f"the record has the entries {sorted(record)} and not those of its method,"
            f" {sorted(columns)}"
        )
    return {name: _value(name, record[name], column.kind) for name, column in columns.items()}


def _value(name: str, value: Any, kind: Any) -> Any:
    if value is None:
        return None
    inner = getattr(kind, "__args__", None)
    if inner:
        return [_value(name, v, inner[0]) for v in value]
    plain: Any = value.item() if hasattr(value, "item") else value  # a number of numpy
    if not isinstance(plain, _PLAIN[kind]) or (isinstance(plain, bool) and kind is not bool):
        raise TypeError(f"{name} is {plain!r}, where its method declares {kind.__name__}")
    return kind(plain)
