"""The report of a discovery: one list of sections, and the one-file page made of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from identification.discovery.result import Discovery
from identification.logs.joined import records_of
from identification.report.discovery_sections import gap_section, rivals_section, where_section
from identification.report.discovery_tables import (
    diff_section,
    parameters_section,
    unseen_section,
)
from identification.report.discovery_verdict import discovery_verdict
from identification.report.law_section import LAWS, law_sections
from identification.report.page import Section, save_figures, write_report


def discovery_sections(found: Discovery, files: str = "") -> list[Section]:
    """The sections of every report of a discovery.

    Args:
        found: the discovery.
        files: a sentence that says where the model with the named effects is.
    """
    return [
        gap_section(found),
        *law_sections(found),
        where_section(found),
        rivals_section(found),
        diff_section(found, files),
        _final_first(parameters_section(found)),
        unseen_section(found),
    ]


def _final_first(section: Section) -> Section:
    """A section whose table has the final values beside the names."""
    return replace(section, table=section.table and section.table.last_first)


def write_discovery_report(
    found: Discovery,
    folder: Path,
    sentences: Sequence[str] = (),
    sections: Sequence[Section] = (),
    files: str = "",
    pictures: bool = True,
) -> Path:
    """Write report.html and its figures into a folder; returns the path of the page.

    Args:
        found: the discovery.
        folder: exists.
        sentences: that follow the verdict.
        sections: that follow those of every report of a discovery.
        files: a sentence that says where the model with the named effects is.
        pictures: whether the figures are written as PNG, too.

    Raises:
        InputError: a file cannot be written.
    """
    shown = [*discovery_sections(found, files), *sections]
    if all(section.video is None for section in shown):  # the law stands where a film would
        shown = [replace(s, first=s.first or s.title == LAWS) for s in shown]
    if pictures:
        save_figures(shown, folder)
    return write_report(
        folder / "report.html",
        f"{found.log.name}: what the model lacks",
        [*discovery_verdict(found), *sentences],
        shown,
        good=found.is_good,
        data=[log.name for _, log in records_of(found.log)],
    )
