"""Memory that was freed goes back to the system."""

import ctypes
from pathlib import Path

import numpy as np
import pytest

from identification.runtime import heap
from identification.runtime.heap import release

STATM = Path("/proc/self/statm")
PAGE, ROOM = 4096, 2**28  # bytes


def resident():
    return PAGE * int(STATM.read_text(encoding="ascii").split()[1])


@pytest.mark.skipif(
    not STATM.exists() or not hasattr(ctypes.CDLL(None), "malloc_trim"), reason="needs glibc"
)
def test_freed_arrays_between_those_that_live_on_leave_the_process():
    each = [np.ones(2**14) for _ in range(ROOM // 2**17)]  # 128 kB: they lie on the heap
    kept = [array[:10].copy() for array in each[::20]]
    full = resident()
    del each
    release()
    assert full - resident() > 0.5 * ROOM
    assert all(array.sum() == 10 for array in kept)


def test_a_library_that_cannot_is_left_alone(monkeypatch):
    heap._trim.cache_clear()
    monkeypatch.setattr(heap.ctypes, "CDLL", lambda name: object())
    assert heap._trim()(0) is None
    release()
    heap._trim.cache_clear()
