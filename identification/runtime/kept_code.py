"""Compiled functions whose machine code is kept beside their files: those of hidden robots.

Numba keeps machine code as long as the file of a function is the same. A function calls those of
other files, and has their code and numbers inside: here it is kept as long as all of them are the
same. The equations of a hidden robot take a quarter of a minute to compile, in every process that
simulates one.
"""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any

from numba import njit


def kept_code(*folders: Path) -> Callable[[Callable[..., Any]], Any]:
    """Returns a decorator that compiles a function when it is first called on a machine.

    A division by zero gives inf, which an integrator finds, and no exception inside a step.

    Args:
        folders: with all files from which the function has code or numbers; it is compiled anew
            when one of them has changed.
    """
    digest = sha256()
    for folder in folders:
        for file in sorted(folder.glob("*.py")):
            digest.update(file.read_bytes())
    sources = digest.hexdigest()

    def compiled(function: Callable[..., Any]) -> Any:
        try:
            made: Any = njit(error_model="numpy", cache=True)(function)
        except RuntimeError:  # numba finds no folder that it may write to: nothing is kept
            return njit(error_model="numpy")(function)
        made._cache._cache_file._source_stamp = sources
        return made

    return compiled
