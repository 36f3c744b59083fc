"""Findings of discoveries on logs of known truth: rates, confusion, reliability.

A row has `truth` (kind, effects with name, where, sizes) and `answer` (verdict, named effects);
`identification.sweep.answers.nested` makes one of a record.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from identification.report.page.page import Section, Table
from identification.sweep.answers import nested
from identification.sweep.method import Findings, Record
from identification.sweep.statistics import calibration_of, median, rate, said, wilson

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Row = Mapping[str, Any]
KINDS = ("null", "single", "pair", "triple", "rule", "sensor", "unknown")
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
    """Returns rates over all records, the confusion matrix, and how far to trust confidence."""
    rows = [nested(record) for record in records]
    found = summary(rows)
    pairs = [(n["confidence"], n["name"] in _true(r)) for r in rows for n in r["answer"]["named"]]
    cells = tuple((words, said(found[key])) for key, words in SAID.items() if found[key]["of"])
    text = "Wilson's 95 % intervals in brackets."
    sections = [
        Section("what was found", text, table=Table(("", "of all"), cells)),
        _confusion(found["confusion"]),
    ]
    if pairs:
        sections.append(_reliability(pairs, found["calibration"]))
    parts = [
        f"{SAID[key]} in {said(found[key])}"
        for key in ("first_name_right", "null_nothing_missing", "unknown_flagged")
        if found[key]["of"]
    ]
    return Findings(found, sections, ["; ".join(parts) + "."] if parts else [])


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


def _true(row: Row) -> set[str]:
    return {effect["name"] for effect in row["truth"]["effects"]}


def _first(row: Row) -> str:
    """Returns the answer's first name, or its verdict where it names nothing."""
    named = row["answer"]["named"]
    return named[0]["name"] if named else row["answer"]["verdict"]


def right(row: Row) -> bool:
    """Returns whether the first name is one of the true ones."""
    return _first(row) in _true(row)


def in_set(row: Row) -> bool:
    """Returns whether the first name, or the one other that data cannot tell from it, is true."""
    named = row["answer"]["named"]
    return bool(named) and bool(_true(row) & {named[0]["name"], *named[0]["set"][:1]})


def _is_exact(row: Row) -> bool:
    """Returns whether every true effect is named and nothing else is."""
    return {named["name"] for named in row["answer"]["named"]} == _true(row)


def _matched(rows: Sequence[Row]) -> list[tuple[Row, Row]]:
    """Returns the named effects whose name is true, each with the truth."""
    out = []
    for row in rows:
        true = {e["name"]: e for e in row["truth"]["effects"]}
        out += [(n, true[n["name"]]) for n in row["answer"]["named"] if n["name"] in true]
    return out


def size_errors(rows: Sequence[Row]) -> list[float]:
    """Returns |estimate - truth| / |truth| of true names, over the sizes that the truth gives."""
    out = []
    for named, true in _matched(rows):
        sizes = {s: v for s, v in true["sizes"].items() if s in named["sizes"]}
        if any(sizes.values()):
            off = math.hypot(*(named["sizes"][s] - v for s, v in sizes.items()))
            out.append(off / math.hypot(*sizes.values()))
    return out


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Returns counts and rates of rows of tasks that met no error."""
    kind = {k: [r for r in rows if r["truth"]["kind"] == k] for k in KINDS}
    known = [r for k, some in kind.items() if k not in ("null", "unknown") for r in some]
    confusion: dict[str, Counter[str]] = {}
    for row in rows:
        true = "+".join(sorted(e["name"] for e in row["truth"]["effects"])) or "nothing"
        confusion.setdefault(true, Counter())[_first(row)] += 1
    signs = [
        value * true["sizes"][size] > 0
        for named, true in _matched(known)
        for size, value in named["sizes"].items()
        if true["sizes"].get(size)
    ]
    places = [named["where"] == true["where"] for named, true in _matched(known) if true["where"]]
    answers = [r["answer"] for r in known if right(r)]
    gaps = [a["gap_closed"] for a in answers if a["named"] and a["gap_closed"] is not None]
    errors = size_errors(known)

    def is_named(row: Row) -> bool:
        return bool(row["answer"]["named"])

    def says(verdict: str) -> Callable[[Row], bool]:
        return lambda row: row["answer"]["verdict"] == verdict

    return {
        "logs": len(rows),
        "failed": 0,
        "first_name_right": rate(known, right),
        "first_name_right_single": rate(kind["single"], right),
        "right_or_in_set_of_two": rate(known, in_set),
        "wrong_name_accepted": rate(known, lambda r: is_named(r) and not right(r)),
        "singles_exactly": rate(kind["single"], _is_exact),
        "pairs_exactly": rate(kind["pair"], _is_exact),
        "triples_exactly": rate(kind["triple"], _is_exact),
        "sign_right": rate(signs, bool),
        "place_right": rate(places, bool),
        "null_without_name": rate(kind["null"], lambda r: not is_named(r)),
        "null_nothing_missing": rate(kind["null"], says("nothing missing")),
        "unknown_flagged": rate(kind["unknown"], says("unknown effect")),
        "unknown_wrongly_named": rate(kind["unknown"], is_named),
        "known_called_unknown": rate(known, says("unknown effect")),
        "gap_closed_median": median(gaps),
        "gap_closed_90_percent": rate(gaps, lambda gap: gap >= 0.9),
        "size_error_median": median(errors),
        "size_within_10_percent": rate(errors, lambda error: error <= 0.1),
        "seconds_median": median([r["seconds"] for r in rows]),
        "calibration": calibration_of(
            [(r["answer"]["named"][0]["confidence"], right(r)) for r in rows if is_named(r)]
        ),
        "confusion": {true: dict(row) for true, row in sorted(confusion.items())},
    }
