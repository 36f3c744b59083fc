"""Linear algebra in one thread, while simulations have the processors.

OpenBLAS lets its threads wait in a busy loop for some 20 ms after each product in which they had a
part. A fit multiplies matrices between simulations all the time, so that every simulation had a
processor less, and of a fit's processor time a tenth was spent waiting (`benchmarks/speed.py`).
The matrices are small enough for one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from threadpoolctl import ThreadpoolController


@cache
def _controller() -> ThreadpoolController:
    """Returns the controller of the loaded libraries of linear algebra; it takes a millisecond."""
    import scipy.linalg  # noqa: F401  slow; loads a library of its own, which is to be found

    return ThreadpoolController()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Let numpy and scipy multiply matrices in one thread; also a decorator."""
    with _controller().limit(limits=1, user_api="blas"):
        yield
