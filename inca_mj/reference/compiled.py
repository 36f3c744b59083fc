"""Compilation of the equations that check the twin, whose machine code is kept beside their files.

Numba keeps machine code as long as the file of a function is the same. A function calls those of
other files, and has their code and numbers inside: here it is kept as long as all of them are the
same. A world takes a quarter of a minute to compile, in every process that makes one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from numba import njit

FOLDERS = ("reference", "robot", "worlds")  # of which the equations import


def compiled(function: Callable[..., Any]) -> Any:
    """Returns a function as machine code, compiled when it is first called on a machine.

    A division by zero gives inf, which the integrator finds, and no exception inside a step.

    Args:
        function: of numbers and arrays, as numba takes it.
    """
    made = njit(error_model="numpy", cache=True)(function)
    made._cache._cache_file._source_stamp = _sources()
    return made


@cache
def _sources() -> str:
    """The digest of all files that the equations may import from, 64 hexadecimal digits."""
    digest = sha256()
    package = Path(__file__).parents[1]
    for folder in FOLDERS:
        for file in sorted((package / folder).glob("*.py")):
            digest.update(file.read_bytes())
    return digest.hexdigest()
