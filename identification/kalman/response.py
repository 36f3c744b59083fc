"""The response of a linearised plant to forcings of its rates, many at once, compiled.

    δx_{l+1} = A_l δx_l + Γ_l g_l,    δx_0 given            l: the intervals of a trajectory

The recursion goes over all intervals for a few columns at a time, whose matrices then stay in a
processor's cache; the threads share the columns.
"""

from __future__ import annotations

from ctypes import POINTER, c_double, c_int64
from functools import cache
from typing import Any

import numpy as np
from numba import carray, types

from identification.native.cache import compile_once
from identification.pool import run_parts, threads

COLUMNS_PER_RECURSION = 64  # at most, so that all threads have some
_DOUBLES: Any = types.CPointer(types.float64)
_INTS: Any = types.CPointer(types.int64)
_SIGNATURE = types.void(*[types.int64] * 6, *[_DOUBLES] * 4, _INTS, _DOUBLES)


def respond(
    A: np.ndarray, Γ: np.ndarray, first: np.ndarray, g: np.ndarray, every: int, rows: np.ndarray
) -> np.ndarray:
    """Computes some entries of the state at the samples.

    Args:
        A: transition over each interval, shape (L, nx, nx).
        Γ: effect of a constant rate of change, shape (L, nx, nf).
        first: the first state of each column, shape (m, nx).
        g: forcings of each column, means over the intervals, shape (m, L, nf).
        every: intervals of a sample.
        rows: indices of r entries of the state, shape (r,).

    Returns:
        Shape (m, N, r), N = L/every + 1.
    """
    L, nx, nf = Γ.shape
    m, wanted = len(g), np.asarray(rows, np.int64)
    out = np.empty((m, L // every + 1, len(wanted)))
    A, Γ, first, g = (np.ascontiguousarray(a, float) for a in (A, Γ, first, g))
    run, workers = _compiled(), threads()
    width = max(1, min(COLUMNS_PER_RECURSION, -(-m // workers)))
    chunks = [slice(k, min(k + width, m)) for k in range(0, m, width)]

    def part(k: int) -> None:
        for chunk in chunks[k::workers]:
            doubles = (a.ctypes.data_as(POINTER(c_double)) for a in (A, Γ, first[chunk], g[chunk]))
            places = wanted.ctypes.data_as(POINTER(c_int64))
            to = out[chunk].ctypes.data_as(POINTER(c_double))
            columns = chunk.stop - chunk.start
            run(L, nx, nf, columns, every, len(wanted), *doubles, places, to)

    run_parts(part, range(min(workers, len(chunks))))
    return out


def _respond(L, nx, nf, m, every, r, A_, Γ_, first_, g_, rows_, out_):  # type: ignore[no-untyped-def]
    A, Γ = carray(A_, (L, nx, nx)), carray(Γ_, (L, nx, nf))
    first, g = carray(first_, (m, nx)), carray(g_, (m, L, nf))
    rows, out = carray(rows_, r), carray(out_, (m, L // every + 1, r))
    x, moved, forced = np.empty((nx, m)), np.empty((nx, m)), np.empty((nf, m))
    for i in range(nx):
        for j in range(m):
            x[i, j] = first[j, i]
    for k in range(L + 1):
        if k % every == 0:
            for i in range(r):
                for j in range(m):
                    out[j, k // every, i] = x[rows[i], j]
        if k == L:
            break
        for j in range(m):
            for i in range(nf):
                forced[i, j] = g[j, k, i]
        np.dot(A[k], x, moved)
        np.dot(Γ[k], forced, x)
        for i in range(nx):
            for j in range(m):
                x[i, j] += moved[i, j]


@cache
def _compiled() -> Any:
    return compile_once(_respond, _SIGNATURE)
