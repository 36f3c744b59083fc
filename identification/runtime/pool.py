"""The threads of this process: one pool of them, and linear algebra in one thread.

A part of some work gives the lock of the interpreter free where it runs machine code: a compiled
recursion, a product of matrices, a simulation. Work that begins inside another part runs in its
thread, so that a part never waits for threads that wait for it. Where the work is given up, by
Ctrl-C or by an error of one part, the other parts end at their next simulation. Work whose time is
limited ends at the first simulation behind its limit (`until`).
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache, lru_cache
from itertools import pairwise
from math import inf
from typing import TypeVar

from threadpoolctl import ThreadpoolController

Part = TypeVar("Part")
Result = TypeVar("Result")
# given_up: where this thread runs a part, whether nobody waits for it
# end: when the work of this thread has to end, in seconds of `time.monotonic`
_here = threading.local()


class GivenUp(BaseException):
    """Nobody waits for what this thread computes."""


class OutOfTime(BaseException):
    """The time is over that was allowed for what this thread computes.

    It is no `Exception`, so that nothing takes it for an evaluation that failed.
    """


def threads() -> int:
    """Returns how many processors this process may use, or fewer if `INCA_MJ_THREADS` says so.

    A part of some work has one of them.
    """
    if hasattr(_here, "given_up"):
        return 1
    allowed = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else ()
    text = os.environ.get("INCA_MJ_THREADS", "")
    most = len(allowed) or os.cpu_count() or 1
    return min(most, int(text)) if text.isdigit() and int(text) else most


@contextmanager
def until(end: float) -> Iterator[None]:
    """Ends the work in the block at its first simulation behind a time.

    Args:
        end: that time, in seconds of `time.monotonic`; infinity for no limit.

    Raises:
        OutOfTime: the time is over.
    """
    before, _here.end = getattr(_here, "end", inf), end
    try:
        yield
    finally:
        _here.end = before


def lift_limit() -> None:
    """Lets the work in the innermost block of `until` of this thread go on behind its time."""
    _here.end = inf


def end_if_given_up() -> None:
    """Ends the work of this thread where nobody waits for it any more, or its time is over.

    Raises:
        GivenUp: nobody waits for it.
        OutOfTime: its time is over.
    """
    if hasattr(_here, "given_up") and _here.given_up.is_set():
        raise GivenUp
    if time.monotonic() > getattr(_here, "end", inf):
        raise OutOfTime


def run_parts(function: Callable[[Part], Result], parts: Iterable[Part]) -> list[Result]:
    """Runs a function on each part of some work, on all threads at once.

    Returns:
        What each call returned, in the order of the parts.
    """
    return [*each_part(function, parts)]


def each_part(function: Callable[[Part], Result], parts: Iterable[Part]) -> Iterator[Result]:
    """Yields what `run_parts` returns, each as soon as it and those before it are done."""
    each, count, given_up = list(parts), threads(), threading.Event()
    end = getattr(_here, "end", inf)
    if len(each) < 2 or count < 2:
        yield from map(function, each)
        return

    def run(part: Part) -> Result:
        _here.given_up = given_up
        try:
            with until(end):
                return function(part)
        finally:
            del _here.given_up

    try:
        yield from _pool(count, os.getpid()).map(run, each)
    except BaseException:
        given_up.set()
        raise


def split(count: int, most: int) -> list[slice]:
    """Splits a count of things into ranges of nearly the same length.

    How many threads there are does not matter to it, so that neither do the last digits of results.
    """
    parts = max(1, -(-count // most))
    return [slice(*pair) for pair in pairwise(count * k // parts for k in range(parts + 1))]


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Let numpy and scipy multiply matrices in one thread; also a decorator."""
    # OpenBLAS lets its threads wait in a busy loop for some 20 ms after each product, so that each
    # simulation of a fit had a processor less (`benchmarks/speed.py`).
    with _controller().limit(limits=1, user_api="blas"):
        yield


@lru_cache(maxsize=1)
def _pool(count: int, process: int) -> ThreadPoolExecutor:
    """Returns the pool of a process; a process that was forked off begins its own."""
    del process
    return ThreadPoolExecutor(count, "inca_mj")


@cache
def _controller() -> ThreadpoolController:
    """Returns the controller of the loaded libraries of linear algebra; it takes a millisecond."""
    import scipy.linalg  # noqa: F401  slow; loads a library of its own, which is to be found

    return ThreadpoolController()
