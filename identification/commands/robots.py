"""A robot and its records, as the commands read them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from identification.log import Log
    from identification.robot import Robot


def robot_and_records(
    robot: Path, log: Path, others: Sequence[Path]
) -> tuple[Robot, tuple[Log, ...]]:
    """The robot compiled for a log, and other records of it.

    Raises:
        InputError: a file cannot be what it should be.
    """
    from identification.robot import read_robot_log, robot_of
    from identification.robot_file import read_robot

    file = read_robot(robot)
    records = tuple(read_robot_log(file, str(path)) for path in others)
    return robot_of(file, read_robot_log(file, str(log))), records
