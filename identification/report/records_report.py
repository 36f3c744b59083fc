"""The one-file report of a discovery on several records."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.prediction.clocks import shown_shifts
from identification.prediction.result import RecordsDiscovery
from identification.report.discovery_figures import gains_figure
from identification.report.effect_words import describe_effect
from identification.report.error_words import pair_words
from identification.report.failed_words import FAILED, failed_lines
from identification.report.law_section import law_sections
from identification.report.page import Section, Table, save_figures, write_report
from identification.report.records_finding_words import describe_shift
from identification.report.records_text import best_scores, rejected_lines, steps_taken
from identification.report.records_values import value_table, value_words
from identification.report.records_verdict import DIGITS, records_verdict
from identification.report.step_words import std_sentence

BEST = 10  # candidates shown


def write_records_report(
    found: RecordsDiscovery, folder: Path, sentences: Sequence[str] = ()
) -> Path:
    """Write report.html and its figures into a folder; returns the path of the page.

    Args:
        found: the discovery.
        folder: exists.
        sentences: that follow the verdict.

    Raises:
        InputError: a file cannot be written.
    """
    shown = [_records(found), *law_sections(found), _candidates(found), _values(found)]
    if shifts := shown_shifts(found.shifts, found.records, found.options):
        shown.append(_shifts(shifts))
    save_figures(shown, folder)
    names = ", ".join(r.log.name for r in found.records if r.role == "fit")
    return write_report(
        folder / "report.html", f"{names}: what the model lacks",
        [*records_verdict(found), *sentences], shown, good=found.is_good,
        data=[r.log.name for r in found.records],
    )  # fmt: skip


def _records(found: RecordsDiscovery) -> Section:
    pairs = pair_words([(e.before_by_unit, e.after_by_unit) for e in found.errors], "", DIGITS)
    rows = tuple((e.name, *pair, e.role) for e, pair in zip(found.errors, pairs, strict=True))
    return Section(
        "Error of prediction by record",
        f"Rms error over windows of {found.horizon:g} s, each from the state that explains it best."
        f" {' '.join(['Nothing was fitted to the records that confirm.', *steps_taken(found)])}",
        table=Table(("record", "nominal model", "final model", "role"), rows),
    )


def _candidates(found: RecordsDiscovery) -> Section:
    best = best_scores(found)[:BEST]
    named = {n.effect.candidate.effect.name for n in found.named}
    # What the records cannot tell from a named effect is named with it.
    named |= {r.candidate.effect.name for n in found.named if n.one_of for r in n.rivals}
    text = "Share of the fitted error that each effect would explain at its best place and shape."
    if found.rejected:
        tried = "\n\n".join(rejected_lines(found))
        text += f"\n\nTried, and not proven on unseen data:\n\n{tried}"
    if failed := failed_lines(found):
        text += "\n\n".join(["", f"{FAILED.capitalize()}:", *failed])
    if not best:
        return Section("Who could explain it", text)
    figure = gains_figure(
        [describe_effect(s.candidate) for s in best], np.array([s.fall for s in best]),
        [s.candidate.effect.name in named for s in best],
        "share of the mean square of the fitted error",
    )  # fmt: skip
    return Section("Who could explain it", text, figures=(("Share of the fitted error", figure),))


def _values(found: RecordsDiscovery) -> Section:
    head, rows = value_table(found)
    steps = std_sentence(found.final, value_words(found))
    return Section(
        "Parameters",
        "Std by blocks of windows, whose errors need not be white; unknown where too few windows"
        f" tell of a value. {steps}".rstrip(),
        table=Table(head, tuple(rows)).last_first,
    )


def _shifts(shifts: Sequence[ShiftedRecord]) -> Section:
    rows = tuple((s.record, describe_shift(s), 100 * s.fall) for s in shifts)
    return Section(
        "Shifts in time",
        "By how much the inputs of a record seem to act later or earlier than their time stamps"
        " say, each record by itself, where both halves of it tell the same. Inputs that seem to"
        " act earlier may also be the answer of a controller to what the robot did.",
        table=Table(("record", "its inputs act", "of its mean square [%]"), rows),
    )
