"""identification inspect LOG, new MODEL LOG: what is in a log, and a robot file to begin with."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from identification.commands.common import OneLog, Output, conclude, table
from identification.quantities import plain_fields


@dataclass(frozen=True)
class Inspect:
    """Say what is in a log: columns, units, rates, gaps, ranges, and which answers which.

    Examples:
        identification inspect run.mcap --out out/run
        identification inspect run.csv
    """

    log: OneLog
    output: Output = Output()

    def run(self) -> int:
        """Inspect, say, draw."""
        from identification.inspection.inspected import inspect_log
        from identification.inspection.words import HEAD, inspection_to_json, rows, sentences

        found = inspect_log(self.log)
        lines = [table(HEAD, rows(found)), *sentences(found)]
        lines.append(f"Next, with your model: identification new MODEL.xml {self.log}")

        def draw(out: Path) -> None:
            from identification.inspection.picture import log_figure
            from identification.report.page.style import save_png

            save_png(log_figure(found), out / "log.png")

        conclude(self, inspection_to_json(found), "\n".join(lines), draw=draw)
        return 0


@dataclass(frozen=True)
class New:
    """Write the robot's file for a model and a log: what was found, guessed, and is still needed.

    Examples:
        identification new arm.xml run.csv
        identification new arm.urdf run.mcap --robot arm.toml
    """

    model: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="MODEL")]
    """MJCF or URDF."""
    log: OneLog
    robot: Annotated[Path, tyro.conf.arg(metavar="FILE")] = Path("robot.toml")
    """Where the file goes; one that exists is never replaced."""
    output: Output = Output()

    def run(self) -> int:
        """Inspect, write, say."""
        from identification.inspection.beginning import write_beginning
        from identification.inspection.inspected import inspect_log

        begun = write_beginning(inspect_log(self.log), self.model, self.robot)
        next_step = f"identification fit {begun.path} {self.log}"
        lines = [f"Written: {begun.path}"]
        for title, said in (
            ("found", begun.found),
            ("guessed, for you to judge", begun.guessed),
            ("needed before a fit", begun.needs),
        ):
            lines += [f"{title}:", *(f"  {each}" for each in said)] if said else []
        lines.append(f"{'When that is done' if begun.needs else 'Next'}: {next_step}")
        if begun.torques:
            lines.append(
                "Its inputs are forces and all joints are measured, so that this answers too, in"
                f" seconds and without a simulation: identification torques {begun.path} {self.log}"
            )
        record = plain_fields(begun, "found", "guessed", "needs") | {"robot": str(begun.path)}
        conclude(self, record, "\n".join(lines))
        return 0
