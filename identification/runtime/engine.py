"""MuJoCo's own library, and what its engine does beside simulating: it warns, and it takes times.

A divergence raises an error here, so the warnings are left out, and no MUJOCO_LOG.TXT is written.
The package `mujoco` installs a clock, with which the engine fills `mjData.timer`. It is asked some
thirty times a step: of a step of the INCA 6D as fits take it, a sixth is the clock's
(`benchmarks/speed.py`). Only the library's variable `mjcb_time` turns it off;
`mujoco.set_mjcb_time(None)` puts the same clock back.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

import mujoco


@cache
def library() -> ctypes.CDLL:
    """Returns MuJoCo's library, which `import mujoco` has loaded."""
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


class _Switch:
    """A switch that its first user turns off, and its last one sets back."""

    def __init__(self, read: Callable[[], Any], write: Callable[[Any], object], off: Any) -> None:
        self._read, self._write, self._off = read, write, off
        self._lock, self._users, self._before = Lock(), 0, None

    @contextmanager
    def turned_off(self) -> Iterator[None]:
        with self._lock:
            if not self._users:
                self._before = self._read()
                self._write(self._off)
            self._users += 1
        try:
            yield
        finally:
            with self._lock:
                self._users -= 1
                if not self._users:
                    self._write(self._before)


_WARNINGS = _Switch(
    lambda: mujoco.get_mju_user_warning(), lambda to: mujoco.set_mju_user_warning(to), _ignore
)
_CLOCK = _Switch(lambda: _clock().value, lambda to: setattr(_clock(), "value", to), None)


def _clock() -> ctypes.c_void_p:
    return ctypes.c_void_p.in_dll(library(), "mjcb_time")


@contextmanager
def quiet() -> Iterator[None]:
    """Ignore the warnings of MuJoCo's engine; also a decorator, `@quiet()`."""
    with _WARNINGS.turned_off():
        yield


def derive(model: mujoco.MjModel) -> None:
    """Writes the numbers that MuJoCo derives from others into a model, without its warnings.

    A body without mass would be warned of on stderr and in a file MUJOCO_LOG.TXT; whoever reads the
    values refuses it in a sentence.
    """
    with quiet():
        mujoco.mj_setConst(model, mujoco.MjData(model))


@contextmanager
def untimed() -> Iterator[None]:
    """Let MuJoCo's engine take no times; `mjData.timer` stays as it is."""
    with _CLOCK.turned_off():
        yield
