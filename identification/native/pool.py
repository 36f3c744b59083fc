"""Threads that run compiled code side by side; they live as long as the process.

Compiled code runs without the interpreter's lock, so that threads are enough. Making them anew for
every call would take longer than many of the calls.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache


def run_parts(function: Callable[[int], object], parts: int) -> None:
    """Run `function(k)` for k = 0 … parts - 1, side by side; the first part in this thread.

    Args:
        function: one part of a work; it must call code that releases the interpreter's lock.
        parts: number of parts.

    Raises:
        Exception: what a part raised, once all of them have ended.
    """
    others = [_threads(os.getpid()).submit(function, k) for k in range(1, parts)]
    try:
        if parts > 0:
            function(0)
    finally:
        errors = [other.exception() for other in others]
    for error in errors:
        if error is not None:
            raise error


@cache
def _threads(process: int) -> ThreadPoolExecutor:
    """The threads of a process; a fork of it has none of them and needs its own."""
    return ThreadPoolExecutor(max_workers=os.cpu_count() or 1, thread_name_prefix="part")
