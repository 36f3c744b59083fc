"""The files of a comparison of torques: result.json and the report."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from identification.report.page import Section, write_report
from identification.report.page_files import PageFiles
from identification.report.torque_report import evidence_to_json, torque_headline, torque_sections
from identification.report.torque_words import torque_verdict
from identification.robot.results import TorqueFit


@dataclass(frozen=True)
class TorqueFiles(PageFiles):
    """The files of a comparison of torques, whose values are a start of a fit and no model."""

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

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        names = [rows.name for rows in self.fitted.found.equations.rows]
        title = f"{', '.join(names)}: torques"
        headline = torque_headline(self.fitted.found, self.fitted.robot.plant.model)
        return write_report(
            path, title, self.record["verdict"], self.sections, data=names, headline=headline
        )
