"""inca view [LOG|RUN]: the robot in MuJoCo's interactive viewer."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

import inca_mj as inca
from identification.errors import InputError
from inca_mj.commands.common import SavedRobot, do_not_draw, saved_robot_field


@dataclass(frozen=True)
class View:
    """Open the interactive viewer: pull at the platform and give currents, or play a log or a run.

    Examples:
        inca view
        inca view examples/log.csv --speed 0.5
    """

    source: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG|RUN")] = None
    """A run (.npz) to play, or a log under whose currents the twin is played."""
    plain: bool = False
    """Show models/inca6d_plain.xml, the approximation that needs MuJoCo only."""
    speed: float = 1.0
    """Seconds of the run in a second; 0.25 is slow motion."""
    robot: Annotated[SavedRobot, tyro.conf.OmitArgPrefixes] = saved_robot_field

    def run(self) -> int:
        """Show it until the window is closed."""
        do_not_draw()  # the viewer has an OpenGL of its own
        from inca_mj.rendering.interactive import refuse_speed, require_screen, view_model, view_run

        if self.plain and self.source is not None:
            raise InputError("--plain shows a model and no run; leave out --plain, or the file")
        refuse_speed(self.speed)
        require_screen()  # before anything is simulated
        if self.source is not None:
            view_run(self._run(self.source), speed=self.speed)
        elif self.plain:
            view_model(inca.build_plain(self.robot.parameters(), self.robot.place()).compile())
        else:
            view_model(self.robot.twin(1e-2).model)
        return 0

    def _run(self, source: Path) -> inca.Run:
        """Returns the run to play."""
        from inca_mj.commands.compare import compare_with
        from inca_mj.twin.logs import UNJUDGED, read_inca_log

        if source.suffix == ".npz":
            return inca.load_run(source)
        return compare_with(self.robot, read_inca_log(source, UNJUDGED), UNJUDGED).run
