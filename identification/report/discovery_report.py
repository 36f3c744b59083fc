"""The report of a discovery: one list of sections, and the one-file page made of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from identification.discovery.result import Discovery
from identification.report.discovery_sections import gap_section, rivals_section, where_section
from identification.report.discovery_tables import (
    diff_section,
    parameters_section,
    records_section,
    shifts_section,
    unseen_section,
)
from identification.report.discovery_verdict import discovery_verdict
from identification.report.law_section import LAWS, law_sections
from identification.report.page import Section, save_figures, write_report

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def discovery_sections(found: Discovery, files: str = "") -> list[Section]:
    """Returns the sections of every report of a discovery.

    Args:
        found: the discovery.
        files: a sentence that says where the model with the named effects is.
    """
    return [
        gap_section(found),
        *records_section(found),
        *law_sections(found),
        *where_section(found),
        rivals_section(found),
        diff_section(found, files),
        _final_first(parameters_section(found)),
        *shifts_section(found),
        *unseen_section(found),
    ]


def _final_first(section: Section) -> Section:
    """Returns a section whose table has the final values beside the names."""
    return replace(section, table=section.table and section.table.last_first)


def write_discovery_report(found: Discovery, folder: Path, sentences: Sequence[str] = ()) -> Path:
    """Write report.html and its figures into a folder; returns the path of the page.

    Args:
        found: the discovery.
        folder: exists.
        sentences: that follow the verdict.

    Raises:
        InputError: a file cannot be written.
    """
    sections = discovery_sections(found)
    save_figures(sections, folder)
    return write_page(found, folder, sections, sentences)


def write_page(
    found: Discovery,
    folder: Path,
    sections: Sequence[Section],
    sentences: Sequence[str] = (),
    drawings: dict[Figure, str] | None = None,
) -> Path:
    """Write report.html of some sections into a folder; returns its path.

    Args:
        found: the discovery.
        folder: exists.
        sections: those of every report of a discovery, and more.
        sentences: that follow the verdict.
        drawings: elements of the page that an earlier page drew of the same figures; the others
            are added.

    Raises:
        InputError: the file cannot be written.
    """
    if all(section.video is None for section in sections):  # the law stands where a film would
        sections = [replace(s, first=s.first or s.title == LAWS) for s in sections]
    fitted = [record.log.name for record in found.records if record.role == "fit"]
    return write_report(
        folder / "report.html",
        f"{', '.join(fitted)}: what the model lacks",
        [*discovery_verdict(found), *sentences],
        sections,
        good=found.is_good,
        data=[record.log.name for record in found.records],
        drawings=drawings,
    )
