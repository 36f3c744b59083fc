"""The files of any result: a report and its figures, both of the same sections."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

from identification.report.page.page import Section, save_figures


class PageFiles(ABC):
    """The files of a result of which nothing but a report is written."""

    @property
    @abstractmethod
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""

    @abstractmethod
    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write no model; other results write theirs."""
        return {}

    def draw(self, folder: Path) -> None:
        """Write the report and its figures into a folder."""
        save_figures(self.sections, folder)
        self.write_page(folder / "report.html")
