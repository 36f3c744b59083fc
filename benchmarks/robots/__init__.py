"""The bench of measured robots: a module a robot, each with a function `read(data)`."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from robots.measured_robot import MeasuredRobot

ROBOTS = ("emps", "silverbox", "xl330", "winch", "pendulum", "double_pendulum", "ur10e")


def reader(name: str) -> Callable[[Path], MeasuredRobot]:
    """The function that reads a robot of `ROBOTS` from the folder of all data.

    The function raises FileNotFoundError where the robot's data are absent.
    """
    read: Callable[[Path], MeasuredRobot] = import_module(f"robots.{name}").read
    return read


def needed(path: Path) -> Path:
    """The path itself, where it is there.

    Raises:
        FileNotFoundError: it is not.
    """
    if not path.exists():
        raise FileNotFoundError(f"{path} is not there")
    return path
