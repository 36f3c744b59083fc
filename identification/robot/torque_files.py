"""The files of a comparison of torques: result.json and the report."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from identification.report.page import Section, save_figures, write_report
from identification.report.torque_headline import torque_headline
from identification.report.torque_json import evidence_to_json
from identification.report.torque_sections import torque_sections
from identification.report.torque_words import torque_verdict
from identification.robot.torque_fit import TorqueFit


@dataclass(frozen=True)
class TorqueFiles:
    """The files of a comparison of torques."""

    fitted: TorqueFit  # the result

    @cached_property
    def record(self) -> dict[str, Any]:
        """The comparison as plain values."""
        robot = self.fitted.robot
        record = evidence_to_json(self.fitted.found, robot.plant.model)
        return {"verdict": torque_verdict(self.fitted.found, robot.plant.model), **record,
                "remarks": list(robot.remarks)}  # fmt: skip

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""
        return torque_sections(self.fitted.found, self.fitted.robot.plant.model)

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write no model: values of torques are a start and a check of a fit, not its end."""
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        names = [rows.name for rows in self.fitted.found.equations.rows]
        title = f"{', '.join(names)}: torques"
        headline = torque_headline(self.fitted.found, self.fitted.robot.plant.model)
        return write_report(
            path, title, self.record["verdict"], self.sections, data=names, headline=headline
        )

    def draw(self, folder: Path) -> None:
        """Write the report and its figures into a folder."""
        save_figures(self.sections, folder)
        self.write_page(folder / "report.html")
