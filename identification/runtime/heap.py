"""The heap of this process, on which the C library keeps what programs free."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache


def release() -> None:
    """Gives freed memory back to the system, where the C library can (glibc).

    Arrays below 32 MiB stay on the heap between those that live on, and a search of several
    records that frees them one by one would hold a gigabyte that nobody uses.
    """
    _trim()(0)


@cache
def _trim() -> Callable[[int], object]:
    """Returns `malloc_trim`, or a function that does nothing where the C library has none."""
    try:
        return ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return lambda kept: None
