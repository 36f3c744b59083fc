"""OpenGL without a display: which backend draws, and one sentence when none can.

MuJoCo reads MUJOCO_GL while it is imported, and with some values the import itself dies. So this
module imports it inside functions only, and a command that draws calls `choose_backend` first.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import os
import sys
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from identification.errors import GraphicsError

if TYPE_CHECKING:
    import mujoco

_OFF = ("disable", "disabled", "off", "false", "0")
_WINDOW = ("", "enable", "enabled", "on", "true", "1", "glfw", "glx")
# Libraries of which each backend needs one of each group: PyOpenGL asks for OpenGL's functions
# beside those of EGL, and MuJoCo's import dies where it finds them nowhere.
_LIBRARIES = {"egl": (("EGL",), ("OpenGL", "GL")), "osmesa": (("OSMesa",),)}
_FIX = (
    "apt-get install libegl1 libopengl0 libgl1-mesa-dri, or set MUJOCO_GL to egl, osmesa or glfw;"
    " everything that does not draw still works"
)

# A second context after a failed one aborts the process inside MuJoCo: the first answer stands.
_failed: list[str] = []
_abandoned: list[object] = []  # renderers that an interrupt has left


def choose_backend() -> str:
    """Settle MUJOCO_GL before MuJoCo is imported; call it in commands that draw.

    On Linux without a display the unset variable becomes "egl". When MuJoCo is imported already,
    its context class is exchanged instead. Returns the value in force, "" where MuJoCo's own choice
    is right; raises GraphicsError where it is unknown or off, or its library is not on this
    machine.
    """
    backend = os.environ.get("MUJOCO_GL", "").lower().strip()
    if backend in _OFF:
        raise GraphicsError(f"MUJOCO_GL={backend} switches drawing off; unset it or set it to egl")
    if not sys.platform.startswith("linux"):
        return backend
    if backend not in (*_WINDOW, *_LIBRARIES):
        raise GraphicsError(f"MUJOCO_GL={backend} is no OpenGL backend; set egl, osmesa or glfw")
    if not backend and not display():
        backend = os.environ["MUJOCO_GL"] = "egl"
    if backend in _LIBRARIES:
        for names in _LIBRARIES[backend]:
            _require(*names)
    elif not display():
        raise GraphicsError(f"MUJOCO_GL={backend} needs a display and there is none; set egl")
    if "mujoco" in sys.modules and backend in _LIBRARIES:
        _rebind(backend)
    return backend


@contextmanager
def renderer(model: mujoco.MjModel, width: int, height: int) -> Iterator[mujoco.Renderer]:
    """Yields an offscreen renderer of that many pixels; raises GraphicsError without OpenGL."""
    choose_backend()
    if _failed:
        raise GraphicsError(_failed[0])
    import mujoco

    try:
        with warnings.catch_warnings():  # GLFW warns of what the sentence below says
            warnings.simplefilter("ignore")
            made = mujoco.Renderer(model, height, width)
    except Exception as error:  # PyOpenGL, GLFW and MuJoCo each have errors of their own
        reason = str(error).strip().splitlines() or [type(error).__name__]
        _failed.append(f"no OpenGL for the film ({reason[0][:80]}): {_FIX}")
        raise GraphicsError(_failed[0]) from error
    try:
        yield made
    except KeyboardInterrupt:  # to free it takes seconds, and the process ends now in any case
        _abandoned.append(made)
        raise
    except BaseException:
        made.close()
        raise
    made.close()


def draws_in_any_thread() -> bool:
    """Returns whether OpenGL draws without a window; windows belong to the main thread."""
    return choose_backend() in _LIBRARIES


@contextmanager
def drawing_thread() -> Iterator[Executor]:
    """Yields a thread in which a renderer may live: one of its own where OpenGL needs no window.

    Windows belong to the main thread (GLFW), so that what would draw in them draws here at once.
    """
    if not draws_in_any_thread():
        yield _ThisThread()
        return
    with ThreadPoolExecutor(1, thread_name_prefix="drawing") as thread:
        yield thread


class _ThisThread(Executor):
    """Calls each function where it is submitted."""

    def submit(self, function: Callable[..., Any], /, *args: Any, **named: Any) -> Future[Any]:
        done: Future[Any] = Future()
        try:
            done.set_result(function(*args, **named))
        except Exception as error:  # as a thread would hand it over
            done.set_exception(error)
        return done


def display() -> str:
    """Returns the name of the screen; "" where there is none."""
    return os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY") or ""


def _require(*names: str) -> None:
    """Refuse to draw where none of some libraries can be loaded."""
    for name in names:
        found = ctypes.util.find_library(name)
        with suppress(OSError):
            if found is not None:
                ctypes.CDLL(found)
                return
    missing = " and ".join(f"lib{name}" for name in names)
    are = "are" if len(names) > 1 else "is"
    raise GraphicsError(f"no OpenGL for the film ({missing} {are} missing): {_FIX}")


def _rebind(backend: str) -> None:
    from mujoco.rendering.classic import gl_context

    try:
        if backend == "egl":
            from mujoco.egl import GLContext
        else:
            from mujoco.osmesa import GLContext
    except (ImportError, AttributeError) as error:
        raise GraphicsError(f"no OpenGL for the film ({error}): {_FIX}") from error
    gl_context.GLContext = GLContext
