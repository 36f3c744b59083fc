"""identification fit|discover|torques ROBOT LOG: the searches on a robot that a TOML describes."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from identification.commands.common import (
    LOG_KINDS,
    LogLists,
    Output,
    Trust,
    conclude,
    flat,
    note,
    parameter_table,
)
from identification.commands.stopping import NO_ANSWER, STOPPED, leaving_out
from identification.errors import InputError
from identification.runtime.progress import duration

if TYPE_CHECKING:
    from identification.robot.robot import Robot
    from identification.storage.written import Files

WORSE = (
    "the fitted values predict unseen records worse than those of the robot's file, and are not to"
    " be used (exit code 1); run discover, which looks for what the model lacks"
)


@dataclass(frozen=True)
class OnRobot:
    """A command on a robot and a log of it."""

    robot: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """TOML that names model, columns, free parameters and candidates."""
    logs: Annotated[
        tuple[Path, ...], tyro.conf.Positional,
        tyro.conf.arg(metavar="LOG", help=f"{LOG_KINDS} Several are fitted together."),
    ]  # fmt: skip
    confirm: LogLists = ()
    """Records to which nothing is fitted."""
    trust: Trust = ()
    spread: str = "usual"
    """How much values that are alike differ: usual (the robot's TOML), none, or a TOML file."""
    output: Output = Output()

    def read(self, but: tuple[str, ...] = (), *, fits: bool = True) -> Robot:
        """Returns the robot, compiled for its log, with the records that confirm.

        The checks `but` are left out. Where something `fits`, some parameters must be free.
        """
        from identification.robot.file.file import read_robot_file, refuse_nothing_free

        if not self.logs:
            raise InputError("no log is given; write LOG behind the robot's file")
        if not all(self.confirm):
            raise InputError("--confirm names no log; write LOG behind it, or leave it out")
        file = read_robot_file(self.robot)  # refuses a wrong one before the imports that are slow
        if fits:
            refuse_nothing_free(file)
        from identification.robot.reading import read_robot

        trust = [*flat(self.trust), *but]
        robot = read_robot(self.robot, self.logs, flat(self.confirm), trust, self.spread)
        for remark in robot.remarks:
            note(remark)
        return robot


@dataclass(frozen=True)
class Fit(OnRobot):
    """Estimate free parameters from one log or several, confirm them on what was not fitted.

    Examples:
        identification fit models/emps.toml log.csv --out out/fit
        identification fit robot.toml a.csv b.csv --confirm c.csv --trust units
    """

    def run(self) -> int:
        """Fit, confirm, say, keep; 1 where unseen records are predicted worse, 130 when stopped."""
        robot = self.read()
        from identification.robot.fitting import fit

        found = fit(robot, self.output.tell)
        files = found.files
        # Whoever stopped it does not wait for figures.
        conclude_files(self, files, _fit_text(files.record), "" if found.stopped else "fit")
        if found.is_worse:
            note(f"identification: {WORSE}")
        return STOPPED if found.stopped else int(found.is_worse)


@dataclass(frozen=True)
class Discover(OnRobot):
    """Find what the model lacks and prove it on unseen data, or say that it is unknown.

    Examples:
        identification discover models/emps.toml log.csv --out out/emps
        identification discover robot.toml a.csv b.csv --confirm c.csv --out out/mine
    """

    options: Annotated[Path | None, tyro.conf.arg(metavar="PATH")] = None
    """TOML file of options: min_proof_t = 3.0, without = ["add_pair"], ... (docs/discovery.md)."""
    minutes: float | None = None
    """Time after which no further effect is sought (10 if not given). What comes before and after
    is always finished and counts besides: the fit without effects, last checks and the report."""

    def run(self) -> int:
        """Discover, confirm, say, keep."""
        from identification.discovery.options import options_of

        options = options_of(self.options, self.minutes)
        robot = self.read()
        from identification.report.discovery.report import discovery_text
        from identification.robot.discovery import discover
        from identification.robot.results.discovery_files import RobotDiscoveryFiles

        with leaving_out(NO_ANSWER):
            found = discover(robot, progress=self.output.tell, options=options)
        files = RobotDiscoveryFiles(found, robot)
        text = "\n".join([discovery_text(found), *files.sentences])
        conclude_files(self, files, text, "search")
        return 0


@dataclass(frozen=True)
class Torques(OnRobot):
    """Compare the drives' forces with those of the motion: base parameters, friction, payloads.

    Examples:
        identification torques arm.toml a.csv b.csv --out out/torques
        identification torques arm.toml a.csv --confirm c.csv --json
    """

    def run(self) -> int:
        """Compare, say, keep."""
        robot = self.read(but=("wiring",), fits=False)  # forces say it without a simulation
        from identification.refusals.wiring import refuse_unbalanced
        from identification.report.torques.words import torque_text
        from identification.robot.file.file import read_robot_file
        from identification.robot.torques import fit_torques

        trust = (*flat(self.trust), *read_robot_file(self.robot).trust)
        judged = replace(robot, file=replace(robot.file, trust=trust))
        for log in (robot.log, *robot.others, *robot.records):
            refuse_unbalanced(judged, log)
        found = fit_torques(judged, self.output.tell)
        files = found.files
        text = torque_text(files.record["verdict"], found.found)
        conclude_files(self, files, text, "comparison")
        return 0


def conclude_files(command: Any, files: Files, text: str, beside: str, saved: str = "") -> None:
    """Saves a result, says it, and draws it beside a search or a fit; see `conclude`.

    Nothing is drawn where `beside` is empty.
    """
    output: Output = command.output

    def draw(out: Path) -> None:
        output.tell("drawing the report")
        began = time.monotonic()
        files.draw(out)
        took = duration(time.monotonic() - began)
        page = (output.out or out) / "report.html"
        output.tell(f"report: {page} (drawn in {took}, beside the {beside})")

    def keep(out: Path) -> None:
        files.keep(out, output.out or out)

    conclude(command, files.record, text, keep, draw if beside else None, saved)


def _fit_text(record: dict[str, Any]) -> str:
    """Returns a fit as a table and its verdict."""
    from identification.quantities import plain_unit

    rows = [
        (name, p["value"], float("inf") if p["std"] is None else p["std"],
         plain_unit(p["unit"]), p["initial"], p["at_bound"])
        for name, p in record["parameters"].items()
    ]  # fmt: skip
    first = int(record["worse"] is not None)  # a warning stands above the values it warns of
    verdict = record["verdict"]
    return "\n".join([*verdict[:first], parameter_table(rows), *verdict[first:]])
