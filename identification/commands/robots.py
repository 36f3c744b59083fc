"""Shared fields of the commands on any robot: its file, its log, and records that confirm."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, flat, note, output_field

if TYPE_CHECKING:
    from identification.robot.robot import Robot


@dataclass(frozen=True)
class OnRobot:
    """A command on a robot and a log of it."""

    robot: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """TOML that names model, columns, free parameters and candidates."""
    logs: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """CSV (with a TOML beside it) or MATLAB .mat with u, y, Ts; several are fitted together."""
    confirm: Annotated[
        tuple[tuple[Path, ...], ...], tyro.conf.UseAppendAction, tyro.conf.arg(metavar="LOG")
    ] = ()
    """Records to which nothing is fitted."""
    trust: Annotated[
        tuple[tuple[str, ...], ...], tyro.conf.UseAppendAction, tyro.conf.arg(metavar="WORD")
    ] = ()
    """What you know better than a check: contacts, gaps, joints, rows, sensors, start, steps, time,
    units, wiring."""
    spread: str = "usual"
    """How much values that are alike differ: usual (the robot's TOML), none, or a TOML file."""
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def read(self) -> Robot:
        """Returns the robot, compiled for its log, with the records that confirm.

        Raises:
            InputError: as `identification.read_robot`.
        """
        from identification.errors import InputError
        from identification.robot.file import read_robot_file

        if not self.logs:
            raise InputError("no log is given; write LOG behind the robot's file")
        read_robot_file(self.robot)  # refuses a wrong file before the imports that are slow
        from identification.robot.reading import read_robot

        robot = read_robot(
            self.robot,
            self.logs,
            flat(self.confirm),
            flat(self.trust),
            self.spread,
        )
        for remark in robot.remarks:
            note(remark)
        return robot
