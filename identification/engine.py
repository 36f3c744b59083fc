"""MuJoCo's own library, and what its engine does beside simulating: it warns, and it takes times.

A divergence raises an error here, so the warnings are left out, and no MUJOCO_LOG.TXT is written.
The package `mujoco` installs a clock, with which the engine fills `mjData.timer`. It is asked some
thirty times a step: of a step of the INCA 6D it takes a seventh. Only the library's variable
`mjcb_time` turns it off; `mujoco.set_mjcb_time(None)` puts the same clock back.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import mujoco


@cache
def library() -> ctypes.CDLL:
    """MuJoCo's library, which `import mujoco` has loaded.

    Raises:
        ImportError: it is not where the package has it.
    """
    folder = Path(mujoco.__file__).parent
    found = sorted(p for p in folder.iterdir() if "mujoco" in p.name and _is_library(p))
    if not found:
        raise ImportError(f"{folder} holds no libmujoco; install mujoco again")
    return ctypes.CDLL(str(found[0]))


def _is_library(path: Path) -> bool:
    return path.name.startswith(("libmujoco.", "mujoco.")) and any(
        end in path.suffixes for end in (".so", ".dylib", ".dll")
    )


@ctypes.CFUNCTYPE(None, ctypes.c_char_p)
def _ignore(message: bytes) -> None:
    """Ignore a warning."""


@contextmanager
def quiet() -> Iterator[None]:
    """Ignore the warnings of MuJoCo's engine; also a decorator, `@quiet()`."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(_ignore)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


@contextmanager
def untimed() -> Iterator[None]:
    """Let MuJoCo's engine take no times; `mjData.timer` stays as it is."""
    clock = ctypes.c_void_p.in_dll(library(), "mjcb_time")
    before = clock.value
    clock.value = None
    try:
        yield
    finally:
        if before:  # else another thread has turned it off, and puts it back
            clock.value = before
