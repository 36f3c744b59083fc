"""inca calibrate LOG...: the values of every drive and the place of every point, from logs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import tyro

import inca_mj as inca
from identification.commands.common import LogLists, Output, conclude, flat, table
from identification.errors import InputError
from inca_mj.commands.common import Trust, Values, do_not_draw, read_logs

FILES = "The calibrated robot is in model.xml and effects.json; inca_mj.load_twin reads them."

GAPS = ("record", "role", "alike", "calibrated")
COMMON = ("parameter", "nominal", "common value")
EACH = ("parameter", *(f"drive {k}" for k in range(1, 9)))
POINTS = ("point", "x", "y", "z")


@dataclass(frozen=True)
class Calibrate:
    """Calibrate drives, geometry and platform from logs, and tell what the logs cannot say.

    Examples:
        inca calibrate examples/log.csv --out out/robot
        inca calibrate a.csv b.csv --confirm c.csv --out out/robot
    """

    log: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """Logs of one robot; without --confirm the second half of each is kept unseen."""
    confirm: LogLists = ()
    """Logs of which only the start pose is fitted; the flag may be given again."""
    spread: str = "usual"
    """How much drives and points usually differ: usual, or a TOML file (models/inca6d_spread.toml
    shows one)."""
    trust: Trust = ()
    """Checks of the log that you overrule: sensors, units, wiring."""
    robot: Values = Values()
    output: Output = Output()

    def run(self) -> int:
        """Calibrate, say, keep."""
        do_not_draw()
        from inca_mj.report.calibration import calibration_json

        if not self.log:
            raise InputError("no log is given; write inca calibrate LOG...")
        trust = flat(self.trust)
        logs, confirm = read_logs(self.log, trust), read_logs(flat(self.confirm), trust)
        spread = inca.spread_of(self.spread)
        found = inca.calibrate(
            logs, self.robot.parameters(), self.robot.place(), confirm=confirm, spread=spread,
            progress=self.output.tell, trust=trust,
        )  # fmt: skip
        record = calibration_json(found)
        conclude(self, record, text(found), partial(keep, found), partial(draw, found))
        return 0


def text(found: inca.Calibration) -> str:
    """Returns the calibration as text for a terminal."""
    from inca_mj.report import calibration as told

    parts = [
        "\n".join(told.calibration_verdict(found)),
        table(GAPS, told.gap_rows(found)),
        table(COMMON, told.common_rows(found)),
        "deviation of each drive [%]\n" + table(EACH, told.drive_rows(found)),
    ]
    if found.spread.points:
        parts.append("displacement [mm]\n" + table(POINTS, told.point_rows(found)))
    return "\n\n".join(parts)


def keep(found: inca.Calibration, out: Path) -> None:
    """Write the twin and its geometry into a folder."""
    from inca_mj.robot.geometry import write_geometry

    inca.save_twin(found.robot, out)
    write_geometry(found.robot.geometry, out / "geometry.toml")


def draw(found: inca.Calibration, out: Path) -> None:
    """Write figures and the report into a folder."""
    from identification.report.page.page import Section, Table, write_report
    from identification.report.page.style import save_png
    from inca_mj.report import calibration as told
    from inca_mj.report.figures import drives_figure, points_figure

    figures = {f"{point}_points": points_figure(found, point) for point in found.spread.points}
    if found.spread.drives:
        figures["drives"] = drives_figure(found)
    for name, figure in figures.items():
        save_png(figure, out / f"{name}.png")
    captions = tuple((name.replace("_", " "), figure) for name, figure in figures.items())
    gaps, common, drives, points = (
        tuple(rows(found))
        for rows in (told.gap_rows, told.common_rows, told.drive_rows, told.point_rows)
    )
    sections = [
        Section(
            "Records", "Free runs over samples that no fit of physical values has seen.",
            table=Table(GAPS, gaps),
        ),
        Section("Common values", table=Table(COMMON, common).last_first),
        Section("Drives and points", figures=captions),
        Section("Deviation of each drive [%]", table=Table(EACH, drives)),
        Section("Displacement of each point [mm]", table=Table(POINTS, points)),
    ]  # fmt: skip
    write_report(
        out / "report.html", "Calibration", told.calibration_verdict(found), sections, footer=FILES
    )
