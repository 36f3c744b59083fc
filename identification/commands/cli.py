"""identification: fit any robot, find what its model lacks, design its next experiment."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Annotated

import tyro

from identification.commands.common import import_without_graphics
from identification.commands.excite import Excite
from identification.commands.inspect import Inspect, New
from identification.commands.linearize import Linearize
from identification.commands.program import run_program
from identification.commands.robots import Discover, Fit, Torques
from identification.commands.sweep import SweepCommand

Command = (
    Annotated[New, tyro.conf.subcommand("new")]
    | Annotated[Fit, tyro.conf.subcommand("fit")]
    | Annotated[Discover, tyro.conf.subcommand("discover")]
    | Annotated[Torques, tyro.conf.subcommand("torques")]
    | Annotated[Excite, tyro.conf.subcommand("excite")]
    | Annotated[Inspect, tyro.conf.subcommand("inspect")]
    | Annotated[Linearize, tyro.conf.subcommand("linearize")]
    | Annotated[SweepCommand, tyro.conf.subcommand("sweep")]
)
EXAMPLES = (
    "identification new robot.xml log.csv",
    "identification discover models/emps.toml log.csv --out out/emps",
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    given = sys.argv[1:] if arguments is None else arguments
    import_without_graphics(own_methods=[*given[:1]] == ["sweep"])
    what = "Fit the parameters of any MJCF to a log, find what it lacks, and linearise it."
    return run_program(Command, "identification", what, arguments, EXAMPLES)
