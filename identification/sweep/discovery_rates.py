"""Results of discoveries on logs of known truth: rates, confusions, calibration of confidence.

A row has `truth` (kind, effects with name, where, sizes) and `answer` (verdict, named effects);
`identification.sweep.answers.nested` makes one of a record.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from identification.sweep.statistics import calibration_of, median, rate, wilson

Row = Mapping[str, Any]


def first(row: Row) -> str:
    """Returns the answer's first name, or its verdict where it names nothing."""
    named = row["answer"]["named"]
    return named[0]["name"] if named else row["answer"]["verdict"]


def right(row: Row) -> bool:
    """Returns whether the first name is one of the true ones."""
    return first(row) in {e["name"] for e in row["truth"]["effects"]}


def in_set(row: Row) -> bool:
    """Returns whether the first name, or the one other that data cannot tell from it, is true."""
    named = row["answer"]["named"]
    return bool(named) and any(
        name in {e["name"] for e in row["truth"]["effects"]}
        for name in (named[0]["name"], *(named[0]["set"][:1]))
    )


def all_found(row: Row) -> bool:
    """Returns whether every true effect is named and nothing else is."""
    return {n["name"] for n in row["answer"]["named"]} == {
        e["name"] for e in row["truth"]["effects"]
    }


def matched(rows: Sequence[Row]) -> list[tuple[Mapping[str, Any], Mapping[str, Any]]]:
    """Returns the named effects whose name is true, each with the truth."""
    out = []
    for row in rows:
        true = {e["name"]: e for e in row["truth"]["effects"]}
        out += [(n, true[n["name"]]) for n in row["answer"]["named"] if n["name"] in true]
    return out


def size_errors(rows: Sequence[Row]) -> list[float]:
    """Returns |estimate - truth| / |truth| of true names, over the sizes that the truth gives."""
    out = []
    for named, true in matched(rows):
        sizes = {s: v for s, v in true["sizes"].items() if s in named["sizes"]}
        if any(sizes.values()):
            off = math.hypot(*(named["sizes"][s] - v for s, v in sizes.items()))
            out.append(off / math.hypot(*sizes.values()))
    return out


def gaps(rows: Sequence[Row]) -> list[float]:
    """Returns the shares of the gap above the noise closed on unseen data, of right first names."""
    return [
        r["answer"]["gap_closed"]
        for r in rows
        if r["answer"]["named"] and right(r) and r["answer"]["gap_closed"] is not None
    ]


def signs(rows: Sequence[Row]) -> dict[str, Any]:
    """Returns the share of the sizes of true names with the right sign."""
    outcomes = [
        value * true["sizes"][size] > 0
        for named, true in matched(rows)
        for size, value in named["sizes"].items()
        if true["sizes"].get(size)
    ]
    return wilson(sum(outcomes), len(outcomes))


def places(rows: Sequence[Row]) -> dict[str, Any]:
    """Returns the share of true names at the right place (drive)."""
    outcomes = [named["where"] == true["where"] for named, true in matched(rows) if true["where"]]
    return wilson(sum(outcomes), len(outcomes))


def calibration(rows: Sequence[Row]) -> dict[str, Any]:
    """Returns expected calibration error and Brier score of the confidence of first names."""
    return calibration_of(
        [(r["answer"]["named"][0]["confidence"], right(r)) for r in rows if r["answer"]["named"]]
    )


def confidences(rows: Sequence[Row]) -> list[tuple[float, bool]]:
    """Returns the confidence of every name of every row, and whether the name is true."""
    return [
        (n["confidence"], n["name"] in {e["name"] for e in r["truth"]["effects"]})
        for r in rows for n in r["answer"]["named"]
    ]  # fmt: skip


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Returns counts and rates of all rows that did not fail."""
    done = [row for row in rows if "error" not in row]
    kind = {k: [r for r in done if r["truth"]["kind"] == k]
            for k in ("null", "single", "pair", "triple", "rule", "sensor", "unknown")}  # fmt: skip
    known = [r for k, some in kind.items() if k not in ("null", "unknown") for r in some]
    confusion: dict[str, Counter[str]] = {}
    for row in done:
        names = [e["name"] for e in row["truth"]["effects"]]
        true = "+".join(sorted(names)) or "nothing"
        confusion.setdefault(true, Counter())[first(row)] += 1
    return {
        "logs": len(done),
        "failed": len(rows) - len(done),
        "first_name_right": rate(known, right),
        "first_name_right_single": rate(kind["single"], right),
        "right_or_in_set_of_two": rate(known, in_set),
        "wrong_name_accepted": rate(known, lambda r: bool(r["answer"]["named"]) and not right(r)),
        "singles_exactly": rate(kind["single"], all_found),
        "pairs_exactly": rate(kind["pair"], all_found),
        "triples_exactly": rate(kind["triple"], all_found),
        "sign_right": signs(known),
        "place_right": places(known),
        "null_without_name": rate(kind["null"], lambda r: not r["answer"]["named"]),
        "null_nothing_missing": rate(
            kind["null"], lambda r: r["answer"]["verdict"] == "nothing missing"
        ),
        "unknown_flagged": rate(
            kind["unknown"], lambda r: r["answer"]["verdict"] == "unknown effect"
        ),
        "unknown_wrongly_named": rate(kind["unknown"], lambda r: bool(r["answer"]["named"])),
        "known_called_unknown": rate(known, lambda r: r["answer"]["verdict"] == "unknown effect"),
        "gap_closed_median": median(gaps(known)),
        "gap_closed_90_percent": wilson(sum(g >= 0.9 for g in gaps(known)), len(gaps(known))),
        "size_error_median": median(size_errors(known)),
        "size_within_10_percent": wilson(
            sum(s <= 0.1 for s in size_errors(known)), len(size_errors(known))
        ),
        "seconds_median": median([r["seconds"] for r in done]),
        "calibration": calibration(done),
        "confusion": {true: dict(row) for true, row in sorted(confusion.items())},
    }
