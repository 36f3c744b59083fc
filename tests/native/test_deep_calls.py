"""A law is compiled however deep the call that asks for it, and the limit stays what it was."""

import inspect
import sys

from numba import types

from identification.native.machine_code import compile_callback

SIGNATURE = types.float64(types.float64)


def twice(x):
    return 2.0 * x


def deeper(calls):
    if calls:
        return deeper(calls - 1)
    return compile_callback(twice, SIGNATURE)


def test_a_law_is_compiled_close_to_the_limit_of_python():
    limit, here = sys.getrecursionlimit(), len(inspect.stack(0))
    pointer, _ = deeper(limit - here - 20)
    assert pointer(21.0) == 42.0
    assert sys.getrecursionlimit() == limit
