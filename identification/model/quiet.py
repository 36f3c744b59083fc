"""MuJoCo without its warnings: a divergence raises an error, and no MUJOCO_LOG.TXT is written."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager

import mujoco


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
