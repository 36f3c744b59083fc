"""What the commands on any robot share: its file, its log, and records that confirm."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, output_field

if TYPE_CHECKING:
    from identification.logs.log import Log
    from identification.robot.robot import Robot


@dataclass(frozen=True)
class OnRobot:
    """A command on a robot and a log of it."""

    robot: Annotated[Path, tyro.conf.Positional]
    """TOML that names model, columns, free parameters and candidates."""
    log: Annotated[Path, tyro.conf.Positional]
    """CSV (with a TOML beside it) or MATLAB .mat with u, y, Ts."""
    confirm: Annotated[tuple[Path, ...], tyro.conf.arg(metavar="LOG")] = ()
    """Records to which nothing is fitted."""
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def read(self) -> tuple[Robot, tuple[Log, ...]]:
        """The robot compiled for its log, and the records that confirm.

        Raises:
            InputError: a file cannot be what it should be, the model's steps are too coarse, or a
                log is not wired as the model is.
        """
        from identification.effects.axes import axes
        from identification.robot.file import read_robot
        from identification.robot.robot import read_robot_log, robot_of
        from identification.robot.step_error import refuse_coarse_steps
        from identification.robot.wiring import refuse_miswired

        file = read_robot(self.robot)
        records = tuple(read_robot_log(file, path) for path in self.confirm)
        robot = robot_of(file, read_robot_log(file, self.log))
        refuse_coarse_steps(robot)
        for log in records:
            axes(robot.plant.model, log)  # a sensor that froze confirms nothing
        for log in (robot.log, *records):
            refuse_miswired(robot, log)
        return robot, records
