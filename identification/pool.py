"""The threads of this process: how many there may be, and one pool of them that lives as long.

A part of some work gives the lock of the interpreter free where it runs machine code: a compiled
recursion, a product of matrices, a simulation. Work that begins inside another part runs in its
thread, so that a part never waits for threads that wait for it.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise
from typing import TypeVar

Part = TypeVar("Part")
Result = TypeVar("Result")

_here = threading.local()  # is_part: whether this thread runs a part


def threads() -> int:
    """The processors that this process may use, or fewer if `INCA_MJ_THREADS` says so."""
    own = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else ()
    said = os.environ.get("INCA_MJ_THREADS", "")
    most = len(own) or os.cpu_count() or 1
    return min(most, int(said)) if said.isdigit() and int(said) else most


def run_parts(function: Callable[[Part], Result], parts: Iterable[Part]) -> list[Result]:
    """Runs a function on each part of some work, on all threads at once.

    Args:
        function: what is done; it spends its time without the lock of the interpreter.
        parts: what each call gets.

    Returns:
        What each call returned, in the order of the parts.
    """
    each, count = list(parts), threads()
    if len(each) < 2 or count < 2 or getattr(_here, "is_part", False):
        return [function(part) for part in each]
    return list(_pool(count, os.getpid()).map(function, each))


def split(count: int, most: int) -> list[slice]:
    """Splits a count of things into ranges of nearly the same length.

    How many threads there are does not matter to it, so that neither do the last digits of results.

    Args:
        count: of things.
        most: things of a range at most.
    """
    parts = max(1, -(-count // most))
    return [slice(*pair) for pair in pairwise(count * k // parts for k in range(parts + 1))]


@lru_cache(maxsize=1)
def _pool(count: int, process: int) -> ThreadPoolExecutor:
    """The pool of a process; a process that was forked off begins its own."""
    del process

    def begin() -> None:
        _here.is_part = True

    return ThreadPoolExecutor(count, "inca_mj", begin)
