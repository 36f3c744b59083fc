"""inca demo: the main job on a shipped log, from the log to a report with a film in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import tyro

from identification.commands.common import Output
from inca_mj.commands.common import Values, values_field
from inca_mj.commands.discover import Discover
from inca_mj.files import example_path


@dataclass(frozen=True)
class Demo:
    """Find what the model lacks of the robot in a log, prove it, film it, write one report.

    Examples:
        inca demo
        inca demo examples/log.csv --no-film --out out/mine
    """

    log: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")] = None
    """The log; the one that comes with the program when none is given."""
    film: bool = True
    """Film the model before and after against unseen seconds of the log."""
    robot: Annotated[Values, tyro.conf.OmitArgPrefixes] = values_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = field(
        default_factory=lambda: Output(out=Path("out/demo"))
    )

    def run(self) -> int:
        """Do all of it, say the verdict first and where the report lies last."""
        log = self.log or example_path()
        return Discover((log,), film=self.film, robot=self.robot, output=self.output).run()
