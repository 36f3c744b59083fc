"""identification fit|discover ROBOT LOG: the two searches on a robot that one TOML describes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from identification.commands.common import (
    LogLists,
    Output,
    conclude,
    flat,
    note,
    output_field,
    parameter_table,
)
from identification.commands.stopping import STOPPED
from identification.errors import InputError
from identification.progress import duration

if TYPE_CHECKING:
    from identification.robot.robot import Robot

WORSE = (
    "the fitted values predict unseen records worse than those of the robot's file, and are not to"
    " be used (exit code 1)"
)


@dataclass(frozen=True)
class OnRobot:
    """A command on a robot and a log of it."""

    robot: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """TOML that names model, columns, free parameters and candidates."""
    logs: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """CSV (with a TOML beside it) or MATLAB .mat with u, y, Ts; several are fitted together."""
    confirm: LogLists = ()
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
        """Returns the robot, compiled for its log, with the records that confirm."""
        from identification.robot.file import read_robot_file

        if not self.logs:
            raise InputError("no log is given; write LOG behind the robot's file")
        read_robot_file(self.robot)  # refuses a wrong file before the imports that are slow
        from identification.robot.reading import read_robot

        robot = read_robot(self.robot, self.logs, flat(self.confirm), flat(self.trust), self.spread)
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
        from identification.robot.confirmation import confirm
        from identification.robot.fit_json import robot_fit_to_json
        from identification.robot.fitting import fit
        from identification.robot.write import write_robot

        found = fit(robot, self.output.tell)
        record = robot_fit_to_json(found, confirm(robot, found))

        def keep(out: Path) -> None:
            place = self.output.out or out
            remark = record["verdict"][0] if found.is_worse or found.stopped else ""
            write_robot(robot, found.shared, out / "robot.toml", place, remark, found.own_values)

        conclude(self, record, _fit_text(record), keep)
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

    def run(self) -> int:
        """Discover, confirm, say, keep."""
        from identification.discovery.options import read_options

        options = None if self.options is None else read_options(self.options)
        robot = self.read()
        from identification.report.discovery_json import discovery_to_json
        from identification.report.discovery_report import discovery_text, write_discovery_report
        from identification.robot.confirmation import confirm
        from identification.robot.discovery import discover
        from identification.robot.reading import doubtful
        from identification.robot.record_error import find_repetitions
        from identification.robot.write import write_robot

        found = discover(robot, progress=self.output.tell, options=options)
        # Over a horizon the report has the errors of every record already.
        pairs = confirm(robot, found) if found.horizon is None else ()
        repeated = find_repetitions(robot)
        sentences = [*doubtful(robot), *map(str, (*pairs, *repeated))]
        record = discovery_to_json(found)
        record |= {
            "located": [*record.get("located", []), *map(str, repeated)],
            "findings": [*record.get("findings", []), *(r.finding for r in repeated)],
            "confirm": [vars(c) for c in pairs],
            "remarks": list(robot.remarks),
        }

        def keep(out: Path) -> None:
            named = {
                n for each in found.named for n in (*each.candidate.sizes, *each.candidate.fixed)
            }
            kept = {*found.nominal.values, *named}
            values = {n: v for n, v in found.final.values.items() if n in kept}
            write_robot(
                robot, values, out / "robot.toml", self.output.out or out,
                own_values=found.final.own_values,
            )  # fmt: skip

        draw = timed(self.output, partial(write_discovery_report, found, sentences=sentences))
        conclude(self, record, "\n".join([discovery_text(found), *sentences]), keep, draw)
        return 0


def timed(output: Output, draw: Callable[..., object]) -> Callable[[Path], None]:
    """Returns what draws figures and report into a folder, and says how long it took."""

    def drawn(out: Path) -> None:
        output.tell("drawing the report")
        began = time.monotonic()
        draw(folder=out)
        took = duration(time.monotonic() - began)
        output.tell(f"report and figures took {took}, beside the search")

    return drawn


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
