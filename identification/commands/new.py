"""identification new MODEL LOG: the robot's file to begin with, and what in it is a guess."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from identification.commands.common import OneLog, Output, conclude, output_field
from identification.quantities import plain_fields


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
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

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
        ready = f"Next: {next_step}"
        lines.append(f"When that is done: {next_step}" if begun.needs else ready)
        if begun.torques:
            lines.append(
                "Its inputs are forces and all joints are measured, so that this answers too, in"
                f" seconds and without a simulation: identification torques {begun.path} {self.log}"
            )
        record = plain_fields(begun, "found", "guessed", "needs") | {"robot": str(begun.path)}
        conclude(self, record, "\n".join(lines))
        return 0
