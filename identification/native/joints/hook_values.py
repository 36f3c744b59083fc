"""The values of one function of an effect at many states of a joint, compiled once for each."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numba import types

from identification.native.cache import compile_once
from identification.native.element import Function
from identification.native.joints.joint_callback import Joint
from identification.native.memory import loader, store_double

_SIGNATURE = types.void(*[types.int64] * 5)


def hook_values(function: Function, states: np.ndarray, numbers: Sequence[float]) -> np.ndarray:
    """Returns what an effect's function for joints says at P states.

    Args:
        function: the njit function (state, parameters).
        states: rows with the fields of `Joint`, each contiguous, shape (P, fields).
        numbers: the parameters, sizes first.
    """
    out, p = np.zeros(len(states)), np.array(numbers, float)
    run = _compiled(function, len(p))
    run(len(states), states.ctypes.data, states.strides[0], p.ctypes.data, out.ctypes.data)
    return out


@cache
def _compiled(function: Function, count: int) -> Any:
    load, read = loader(count), loader(len(Joint._fields))

    def values(points, states, apart, numbers, out):  # type: ignore[no-untyped-def]
        p = load(numbers)
        for k in range(points):
            store_double(out + 8 * k, function(Joint(*read(states + apart * k)), p))

    return compile_once(values, _SIGNATURE)
