"""Calls of compiled functions that take sizes and addresses of arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from ctypes import POINTER, c_double, c_int64
from functools import cache
from threading import Lock
from typing import Any

import numpy as np
from numba import types

from identification.native.cache import compile_once

# Addresses of arrays of doubles and of integers, to numba and to ctypes.
ADDRESSES: dict[str, tuple[Any, Any]] = {
    "f": (types.CPointer(types.float64), POINTER(c_double)),
    "i": (types.CPointer(types.int64), POINTER(c_int64)),
}
_LOCK = Lock()


def call(
    function: Callable[..., Any], sizes: tuple[int, ...], arrays: Iterable[np.ndarray]
) -> None:
    """Runs a function of sizes and of the addresses of arrays, which is compiled once."""
    given = [(a, *ADDRESSES[a.dtype.kind]) for a in arrays]
    with _LOCK:  # one of several threads compiles
        run = _compiled(function, len(sizes), tuple(kind for _, kind, _ in given))
    run(*sizes, *(a.ctypes.data_as(pointer) for a, _, pointer in given))


@cache
def _compiled(function: Callable[..., Any], sizes: int, kinds: tuple[Any, ...]) -> Any:
    return compile_once(function, types.void(*[types.int64] * sizes, *kinds))
