"""python -m identification discover ROBOT LOG: what the model of any robot lacks."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.commands.common import (
    note,
    refuse_folder,
    say,
    say_json,
    write_result,
)
from identification.commands.robots import OnRobot

if TYPE_CHECKING:
    from identification.discovery.result import Discovery


@dataclass(frozen=True)
class Discover(OnRobot):
    """Find what the model lacks and prove it on unseen data, or say that it is unknown."""

    def run(self) -> int:
        """Discover, confirm, say, keep."""
        from identification.discovery.final_values import final_values
        from identification.files import whole_folder
        from identification.report.discovery_json import discovery_to_json
        from identification.report.discovery_text import discovery_text, finite
        from identification.robot.confirmation import confirm
        from identification.robot.discovery import discover
        from identification.robot.write import write_robot

        refuse_folder(self.output.out)
        robot = self.read()
        found = discover(robot, progress=note)
        pairs = confirm(robot, found)
        record: dict[str, Any] = finite(discovery_to_json(found))
        record = {**record, "confirm": [vars(c) for c in pairs]}
        if self.output.json:
            say_json(record)
        else:
            say("\n".join([discovery_text(found), *map(str, pairs)]))
        if self.output.out is not None:
            with whole_folder(self.output.out) as out:
                _keep(found, [str(c) for c in pairs], out)
                has = {
                    n
                    for named in found.named
                    for n in (*named.candidate.sizes, *named.candidate.fixed)
                }
                values = {
                    n: v for n, v in final_values(found).items() if n in (*robot.file.free, *has)
                }
                write_robot(robot, values, out / "robot.toml", self.output.out)
                write_result(out / "result.json", self, record)
        return 0


def _keep(found: Discovery, confirmed: list[str], out: Path) -> None:
    """Write the report and its figures into a folder."""
    from identification.report import discovery_sections as parts
    from identification.report import discovery_tables as tables
    from identification.report.discovery_verdict import discovery_verdict
    from identification.report.page import save_figures, write_report

    sections = [
        parts.gap_section(found),
        parts.where_section(found),
        parts.rivals_section(found),
        tables.diff_section(found),
        tables.parameters_section(found),
        tables.unseen_section(found),
    ]
    save_figures(sections, out)
    write_report(
        out / "report.html",
        f"{found.log.name}: what the model lacks",
        [*discovery_verdict(found), *confirmed],
        sections,
        good=False if found.verdict == "unknown effect" else None if found.unexplained else True,
    )
