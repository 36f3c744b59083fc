"""The report of a discovery: text for a terminal and a one-file page, of the same sections."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from identification.discovery.result import Discovery
from identification.report.discovery_headline import discovery_headline
from identification.report.discovery_sections import (
    gap_section,
    parameters_section,
    records_section,
    shifts_section,
    steps_taken,
    unseen_section,
    where_section,
)
from identification.report.discovery_verdict import (
    discovery_verdict,
    further_sentences,
)
from identification.report.effect_sections import added_section, rivals_section, tried_section
from identification.report.horizon_section import horizon_sections
from identification.report.law import law_sections
from identification.report.nothing_words import is_above_noise
from identification.report.page import Section, write_report

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def discovery_text(found: Discovery) -> str:
    """Returns the whole outcome as text: the verdict first, then what was added and the rest."""
    sections = [
        added_section(found),
        gap_section(found),
        *records_section(found),
        parameters_section(found),
        *shifts_section(found),
        *where_section(found),
        *horizon_sections(found),
        rivals_section(found),
        *tried_section(found),
        *unseen_section(found),
    ]
    parts = [
        "\n".join(discovery_verdict(found)),
        *(section.plain for section in sections),
        "\n".join(further_sentences(found)),
        *steps_taken(found),
        f"The search took {found.took:.1f} s.",
    ]
    return "\n\n".join(filter(None, parts))


def discovery_sections(found: Discovery, files: str = "") -> list[Section]:
    """Returns the sections of every page on a discovery; `files` says where the new model is."""
    return [
        gap_section(found),
        *records_section(found),
        *law_sections(found),
        *where_section(found),
        *horizon_sections(found),
        rivals_section(found),
        *tried_section(found),
        added_section(found, files),
        parameters_section(found),
        *shifts_section(found),
        *unseen_section(found),
    ]


def write_page(
    found: Discovery,
    path: Path,
    sections: Sequence[Section],
    sentences: Sequence[str] = (),
    drawings: dict[Figure, str] | None = None,
) -> Path:
    """Write the report of a discovery, one HTML file of some sections; returns its path.

    Raises:
        InputError: the file cannot be written.
    """
    is_open = found.verdict == "nothing missing" and is_above_noise(found)
    fitted = [record.log.name for record in found.records if record.role == "fit"]
    return write_report(
        path,
        f"{', '.join(fitted)}: what the model lacks",
        [*discovery_verdict(found), *sentences],
        sections,
        good=None if is_open else found.is_good,
        data=[record.log.name for record in found.records],
        drawings=drawings,
        headline=discovery_headline(found),
        further=further_sentences(found),
    )
