"""Findings of discoveries on logs of known truth: rates, confusion, reliability."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from identification.report.page import Section, Table
from identification.sweep.answers import nested
from identification.sweep.discovery_rates import confidences, summary
from identification.sweep.method import Findings, Record
from identification.sweep.statistics import said, wilson

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAID = {
    "first_name_right": "the right name first",
    "right_or_in_set_of_two": "or in a set of two",
    "wrong_name_accepted": "a wrong name first",
    "singles_exactly": "one effect, and exactly it named",
    "pairs_exactly": "two effects, and exactly they named",
    "triples_exactly": "three effects, and exactly they named",
    "sign_right": "right sign of a size",
    "place_right": "right place of a true name",
    "null_without_name": "nothing hidden, and nothing named",
    "null_nothing_missing": 'nothing hidden, and "nothing missing"',
    "unknown_flagged": 'an unlisted effect, and "unknown effect"',
    "unknown_wrongly_named": "an unlisted effect, and a name",
    "known_called_unknown": 'a listed effect, and "unknown effect"',
    "gap_closed_90_percent": "90 % of the gap closed, when named right",
    "size_within_10_percent": "size within 10 %, when named right",
}


def discovery_findings(records: Sequence[Record]) -> Findings:
    """Returns rates over all records, the confusion matrix, and how far to trust confidence.

    Args:
        records: with the columns `TRUTH`, `ANSWER` and `PROOF` of `identification.sweep.answers`.
    """
    rows = [nested(record) for record in records]
    found = summary(rows)
    pairs = confidences(rows)
    cells = tuple((words, said(found[key])) for key, words in SAID.items() if found[key]["of"])
    text = "Wilson's 95 % intervals in brackets."
    sections = [
        Section("what was found", text, table=Table(("", "of all"), cells)),
        _confusion(found["confusion"]),
    ]
    if pairs:
        sections.append(_reliability(pairs, found["calibration"]))
    return Findings(found, sections, _sentences(found))


def _confusion(confusion: dict[str, dict[str, int]]) -> Section:
    from identification.sweep.figures import MANY, confusion_figure

    text = "Rows: what is hidden; columns: the first name, or the verdict where there is none."
    rows = tuple(
        (true, ", ".join(f"{name} {count}" for name, count in row.items()))
        for true, row in confusion.items()
    )
    figures: tuple[tuple[str, Figure], ...] = ()
    if len(confusion) <= MANY:
        figures = (("Truth and answer", confusion_figure(confusion)),)
    return Section("confusion matrix", text, figures, Table(("truth", "answers"), rows))


def _reliability(pairs: Sequence[tuple[float, bool]], first: dict[str, Any]) -> Section:
    from identification.sweep.figures import reliability_figure

    hits = sum(right for _, right in pairs)
    text = f"Of all names {said(wilson(hits, len(pairs)))} are true."
    if first["of"]:
        text += (
            f" Of first names the expected calibration error is {first['ece']:.3f} and the Brier"
            f" score {first['brier']:.3f}."
        )
    figures = (("Reliability of confidence", reliability_figure(pairs)),)
    return Section("reliability", text, figures)


def _sentences(found: dict[str, Any]) -> list[str]:
    parts = [
        f"{SAID[key]} in {said(found[key])}"
        for key in ("first_name_right", "null_nothing_missing", "unknown_flagged")
        if found[key]["of"]
    ]
    return ["; ".join(parts) + "."] if parts else []
