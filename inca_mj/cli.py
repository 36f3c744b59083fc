"""The program `inca`: its commands, and the two that need no file of their own, sweep and cite."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import tyro

from identification.commands.common import import_without_graphics, say, say_json
from identification.commands.program import run_program
from identification.commands.sweep import SweepCommand
from inca_mj.commands.calibrate import Calibrate
from inca_mj.commands.compare import Compare, Crosscheck
from inca_mj.commands.discover import Demo, Discover
from inca_mj.commands.experiment import Excite, Sensitivity
from inca_mj.commands.film import Film, View
from inca_mj.commands.identify import Identify
from inca_mj.commands.kinematics import Kinematics
from inca_mj.commands.linearize import Linearize
from inca_mj.commands.simulate import Simulate
from inca_mj.commands.statics import Statics
from inca_mj.commands.thesis import Thesis, Trials
from inca_mj.commands.track import Track


@dataclass(frozen=True)
class Sweep(SweepCommand):
    """Run the tasks of a sweep, keep a record of each, and say what they come to.

    Examples:
        inca sweep benchmarks/sweeps/trials.toml --jobs 2 --out out/trials
        inca sweep benchmarks/sweeps/null_score.toml --backend dask --resume
    """

    def run(self) -> int:
        """Run, keep, say; 1 where every task met an error."""
        import_without_graphics(own_methods=True)
        return super().run()

    def methods(self) -> Mapping[str, str]:
        """Returns the methods that a sweep may name: those on any robot, and those on INCA."""
        from inca_mj.studies import METHODS

        return METHODS


@dataclass(frozen=True)
class Cite:
    """Say how to cite this program and the thesis that its equations are of.

    Examples:
        inca cite
        inca cite --bibtex
    """

    bibtex: bool = False
    """Print BibTeX entries."""
    json: bool = False
    """Print one JSON object on stdout and nothing else."""

    def run(self) -> int:
        """Print the citation."""
        from inca_mj.report.citation import to_bibtex, to_text, works

        if self.json:
            say_json({"works": works(), "text": to_text(), "bibtex": to_bibtex()})
        else:
            say(to_bibtex() if self.bibtex else to_text())
        return 0


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
