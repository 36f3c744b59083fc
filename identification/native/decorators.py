"""njit for functions that only compiled code calls.

Numba also makes a wrapper for Python of every function; leaving it out halves the compilation. The
functions of effects are plain njit functions, because Python calls some of them at the start.
"""

from __future__ import annotations

from typing import Any

from numba import njit

_OPTIONS: Any = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # numba's stubs lack them

internal = njit(**_OPTIONS)
inlined = njit(forceinline=True, **_OPTIONS)
