"""The one place where a callback is compiled."""

from __future__ import annotations

from typing import Any

from numba import cfunc

from identification.native.element import Function


def compiled(name: str, function: Function, signature: Any) -> Any:
    """A function as machine code that C code can call.

    Everything that is compiled into it can be reached from `function`: the njit functions of the
    effects are among its closure's variables.

    Args:
        name: tells it from the other callbacks of a process, e.g. "joints.passive".
        function: what is compiled. It must not raise.
        signature: its numba signature.

    Returns:
        A ctypes function, which Python and MuJoCo can call.
    """
    callback = cfunc(signature, error_model="numpy")(function)
    pointer: Any = callback.ctypes
    pointer.callback = callback  # the machine code lives as long as the pointer to it
    return pointer
