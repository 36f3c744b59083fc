"""The files of a discovery on the robot: also the twin with what was named."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import DiscoveryFiles, discovery_sections, write_page
from identification.report.page.page import Section
from inca_mj.twin.saved import save_twin
from inca_mj.twin.section import model_section
from inca_mj.twin.twin import Twin
from inca_mj.workflows.discovery_model import named_twin

SAVED = "The model with it is in model.xml and effects.json; inca_mj.load_twin reads them."


@dataclass(frozen=True)
class TwinDiscoveryFiles(DiscoveryFiles):
    """The files of a discovery on a twin."""

    @property
    def record(self) -> dict[str, Any]:
        """The discovery as plain values; `model` is the path of the twin where it is saved."""
        return {**discovery_to_json(self.found), "model": None}

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once; the last one is on the twin."""
        twin = model_section(_without_zeros(named_twin(self.found)))
        return [*discovery_sections(self.found, SAVED), twin]

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write the twin with what was named: model.xml and effects.json."""
        model, _ = save_twin(named_twin(self.found), folder)
        return {"model": model.name}

    def write_filmed(self, path: Path, film: Section) -> Path:
        """Write the report with the section of a film; returns its path."""
        *shown, twin = self.sections
        return write_page(self.found, path, [*shown, film, twin], drawings=self.drawings)


def _without_zeros(robot: Twin) -> Twin:
    """Returns the twin without parameters of effects that are zero, which no table needs."""
    shown = tuple(p for p in robot.parameters if p.where != "effect" or p.value)
    return replace(robot, parameters=replace(robot.parameters, records=shown))
