"""The files of a discovery: result.json and the report; what was searched may add to both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.discovery.result import Discovery
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_report import discovery_sections, write_page
from identification.report.page import Section
from identification.report.page_files import PageFiles

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class DiscoveryFiles(PageFiles):
    """The files of a discovery on a model by hand, which no file describes."""

    found: Discovery  # the discovery

    @property
    def record(self) -> dict[str, Any]:
        """The discovery as plain values."""
        return discovery_to_json(self.found)

    @property
    def sentences(self) -> Sequence[str]:
        """What is said behind the verdict."""
        return ()

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""
        return discovery_sections(self.found)

    @cached_property
    def drawings(self) -> dict[Figure, str]:
        """What was drawn for an earlier page, which the next page has too."""
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        return write_page(self.found, path, self.sections, self.sentences, self.drawings)
