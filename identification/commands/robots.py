"""What the commands on any robot share: its file, its log, and records that confirm."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, output_field

if TYPE_CHECKING:
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

    def read(self) -> Robot:
        """The robot, compiled for its log, with the records that confirm.

        Raises:
            InputError: as `identification.read_robot`.
        """
        from identification.robot.reading import read_robot

        return read_robot(self.robot, self.log, self.confirm)
