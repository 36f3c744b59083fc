"""MuJoCo's interactive viewer: the robot to pull at, or a run played again and again.

A window needs a screen. Where there is none, `require_screen` says so before anything is imported
that would hang or warn; `inca_mj.rendering.film` draws without a screen.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from identification.errors import GraphicsError, InputError
from inca_mj.rendering.graphics import display
from inca_mj.twin.run import Run

_FRAME = 1 / 60  # [s]
_INSTEAD = "inca film draws without a screen"


def require_screen() -> None:
    """Refuses, with a GraphicsError, to open a window where there is no screen."""
    named = display()
    if sys.platform.startswith("linux") and not named:
        raise GraphicsError(
            "no screen for the viewer: neither DISPLAY nor WAYLAND_DISPLAY is set; start it on a"
            f" desktop, or {_INSTEAD}"
        )
    import glfw

    with warnings.catch_warnings():  # GLFW warns of what the sentence below says
        warnings.simplefilter("ignore")
        opened = glfw.init()
    if not opened:
        raise GraphicsError(f"the screen {named} cannot be opened; start a desktop, or {_INSTEAD}")


def view_model(model: mujoco.MjModel) -> None:
    """Simulates a model in the viewer from its reset until its window is closed."""
    require_screen()
    import mujoco.viewer

    mujoco.viewer.launch(model, mujoco.MjData(model))


def view_run(run: Run, *, speed: float = 1.0) -> None:
    """Plays a run in the viewer again and again until its window is closed.

    `speed` is seconds of the run in a second. Raises InputError if it is not positive, and
    GraphicsError if there is no screen or this Python may not open a window on it.
    """
    refuse_speed(speed)
    require_screen()
    import mujoco.viewer

    data = mujoco.MjData(run.twin.model)
    show(run, data, 0)
    try:
        opened = mujoco.viewer.launch_passive(run.twin.model, data)
    except RuntimeError as error:  # on macOS only mjpython may
        raise GraphicsError(f"{error}; or {_INSTEAD}") from error
    with opened as window:
        play(run, data, window, speed)


def refuse_speed(speed: float) -> None:
    """Refuses a speed that is not a positive number."""
    if not 0 < speed < np.inf:
        raise InputError(f"a speed of {speed:g} is not a positive number; give one such as 0.25")


def play(
    run: Run,
    data: mujoco.MjData,
    window: Any,
    speed: float = 1.0,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> None:
    """Puts the states of a run into a window, in time with a clock [s], until the window is closed.

    The window has `is_running`, `lock` and `sync`, as the handle of `mujoco.viewer`.
    """
    first, length = clock(), float(run.time[-1] - run.time[0])
    while window.is_running():
        now = run.time[0] + (speed * (clock() - first)) % length
        with window.lock():
            show(run, data, int(np.searchsorted(run.time, now, side="right")) - 1)
        window.sync()
        sleep(_FRAME)


def show(run: Run, data: mujoco.MjData, k: int) -> None:
    """Put sample k of a run into data."""
    data.time, data.qpos[:], data.qvel[:] = run.time[k], run.qpos[k], run.qvel[k]
    data.ctrl[:] = run.currents[k]
    mujoco.mj_fwdPosition(run.twin.model, data)
