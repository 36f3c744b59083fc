"""The program `inca`: one command a file in `inca_mj.commands`; heavy imports wait until needed."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Annotated

import tyro

from identification.commands.program import run_program
from inca_mj.commands.calibrate import Calibrate
from inca_mj.commands.cite import Cite
from inca_mj.commands.compare import Compare
from inca_mj.commands.crosscheck import Crosscheck
from inca_mj.commands.demo import Demo
from inca_mj.commands.discover import Discover
from inca_mj.commands.excite import Excite
from inca_mj.commands.film import Film
from inca_mj.commands.identify import Identify
from inca_mj.commands.kinematics import Kinematics
from inca_mj.commands.linearize import Linearize
from inca_mj.commands.sensitivity import Sensitivity
from inca_mj.commands.simulate import Simulate
from inca_mj.commands.statics import Statics
from inca_mj.commands.sweep import Sweep
from inca_mj.commands.thesis import Thesis
from inca_mj.commands.track import Track
from inca_mj.commands.trials import Trials
from inca_mj.commands.view import View

Command = (
    Annotated[Simulate, tyro.conf.subcommand("simulate")]
    | Annotated[Compare, tyro.conf.subcommand("compare")]
    | Annotated[Crosscheck, tyro.conf.subcommand("crosscheck")]
    | Annotated[Identify, tyro.conf.subcommand("identify")]
    | Annotated[Calibrate, tyro.conf.subcommand("calibrate")]
    | Annotated[Discover, tyro.conf.subcommand("discover")]
    | Annotated[Kinematics, tyro.conf.subcommand("kinematics")]
    | Annotated[Sensitivity, tyro.conf.subcommand("sensitivity")]
    | Annotated[Excite, tyro.conf.subcommand("excite")]
    | Annotated[Linearize, tyro.conf.subcommand("linearize")]
    | Annotated[Trials, tyro.conf.subcommand("trials")]
    | Annotated[Statics, tyro.conf.subcommand("statics")]
    | Annotated[Track, tyro.conf.subcommand("track")]
    | Annotated[Thesis, tyro.conf.subcommand("thesis")]
    | Annotated[Sweep, tyro.conf.subcommand("sweep")]
    | Annotated[Film, tyro.conf.subcommand("film")]
    | Annotated[View, tyro.conf.subcommand("view")]
    | Annotated[Demo, tyro.conf.subcommand("demo")]
    | Annotated[Cite, tyro.conf.subcommand("cite")]
)
EXAMPLES = ("inca demo", "inca discover examples/log.csv --spread none --out out/discover")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    what = "The digital twin of the INCA 6D cable robot, and what it lacks."
    return run_program(Command, "inca", what, arguments, EXAMPLES)


if __name__ == "__main__":
    sys.exit(main())
