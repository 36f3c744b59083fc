"""What a study of hidden joints comes to: rates with Wilson's intervals, and confusions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from identification.prediction.judging.trial import LEVEL, TWINS
from identification.sweep.statistics import median, rate

WORSE = 1.02  # of an error: two searches that end at the same minimum differ by less
NULL, THREE = "nothing", "three"
BANDS = (0.0, 0.5, 0.8, 0.9, 1.0)  # of confidence; 0.85 is the most that is said of a name where
# something is left, 0.95 else
Row = Mapping[str, Any]


def first(row: Row) -> str:
    """The first name, or the verdict."""
    return str(row["named"][0]["name"] if row["named"] else row["verdict"])


def right_names(row: Row) -> set[str]:
    """Names that say what is hidden, those of the same force among them (`prediction.twins`)."""
    truth = row["truth"]
    names, level = set(truth["names"]), truth["parameters"].get(f"{LEVEL}@{truth['joint']}", 0.0)
    if truth["effect"] in TWINS and abs(truth["size"]) < level:
        names.add(TWINS[truth["effect"]])
    return names


def is_right(row: Row) -> bool:
    """The first name is one that is right."""
    return bool(row["named"]) and first(row) in right_names(row)


def is_right_or_alike(row: Row) -> bool:
    """The first name is right, or the one that the records cannot tell from it."""
    if not row["named"]:
        return False
    named = row["named"][0]
    alike = named["rivals"][:1] if named["one_of"] else []
    return bool({named["name"], *alike} & right_names(row))


def is_placed(row: Row) -> bool:
    """The place is the joint on which the effect acts, its input, its sensor, or the body."""
    place = str(row["named"][0]["where"])
    return any(own in place for own in row["truth"]["places"])


def is_worse(row: Row) -> bool:
    """What was found predicts the other record worse than what `fit` fitted."""
    errors = row["errors"]
    return bool(errors["discover"] > WORSE * errors["fit"])


def is_fit_worse(row: Row) -> bool:
    """`fit` predicts the other record worse than the values with which it began."""
    return bool(row["errors"]["fit"] > WORSE * row["errors"]["written"])


def is_null(row: Row) -> bool:
    return bool(row["truth"]["effect"] == NULL)


def is_unlisted(row: Row) -> bool:
    """A force that is in no catalogue; rows from before such worlds say nothing of it."""
    return bool(row["truth"].get("curve"))


def is_of_several(row: Row) -> bool:
    """Several effects of the catalogue act at once; rows from before such worlds have none."""
    return bool(row["truth"].get("acting"))


def names_of(acting: Mapping[str, Any], row: Row) -> set[str]:
    """Names that say what one of several effects is, those of the same force among them."""
    names, effect = set(acting["names"]), acting["effect"]
    level = row["truth"]["parameters"].get(f"{LEVEL}@{acting['joint']}", 0.0)
    if effect in TWINS and abs(acting["size"]) < level:
        names.add(TWINS[effect])
    return names


def is_named(acting: Mapping[str, Any], named: Mapping[str, Any], row: Row) -> bool:
    """A name says what one of several effects is, and where; or the first that is like it does."""
    alike = named["rivals"][:1] if named["one_of"] else []
    is_there = not acting["places"] or any(p in str(named["where"]) for p in acting["places"])
    return is_there and bool({named["name"], *alike} & names_of(acting, row))


def count_found(row: Row) -> int:
    """How many of several effects are named."""
    return sum(any(is_named(a, n, row) for n in row["named"]) for a in row["truth"]["acting"])


def has_false_name(row: Row) -> bool:
    """A law is named that is none of several effects."""
    laws = [n for n in row["named"] if not n["name"].startswith("curve_")]
    return any(not any(is_named(a, n, row) for a in row["truth"]["acting"]) for n in laws)


def is_all_said(row: Row) -> bool:
    """Some of several effects are not named, and nothing is said to be left."""
    is_part = count_found(row) < len(row["truth"]["acting"])
    return is_part and not row.get("unexplained") and row["verdict"] != "unknown effect"


def is_law_named(row: Row) -> bool:
    """A law is named, which is wrong where the force is in no catalogue."""
    return any(not named["name"].startswith("curve_") for named in row["named"])


def is_drawn(row: Row) -> bool:
    """It is drawn as a curve of something at the right joint, and nothing is named."""
    return bool(row["named"]) and not is_law_named(row) and is_placed(row)


def refused(row: Row) -> set[str]:
    """Laws that were not named, because a smooth force of what they depend on explains more."""
    return {name for name, _, doubt in row.get("rejected", ()) if doubt == "neighbour"}


def is_unknown(row: Row) -> bool:
    return bool(row["verdict"] == "unknown effect")


def is_drawn_over_its_cause(row: Row) -> bool:
    """And the curve is over what the force depends on."""
    return is_drawn(row) and first(row) == row["truth"]["curve"]


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Rates over all robots, and of each."""
    every = [r for r in rows if "verdict" in r]
    done = [r for r in every if not is_of_several(r)]
    robots = sorted({r["truth"]["robot"] for r in every})
    return {
        "worlds": len(every),
        "failed": sum("error" in r for r in rows),
        "unseen": sum("unseen" in r for r in rows),
        "all": _rates(done),
        **{name: _rates([r for r in done if r["truth"]["robot"] == name]) for name in robots},
        "confusion": confusion(done),
        "reliability": reliability(done),
        "unlisted": {name: _rates_of_unlisted([r for r in done if r["truth"]["robot"] == name])
                     for name in robots} | {"all": _rates_of_unlisted(done)},
        "several": {name: _rates_of_several([r for r in every if r["truth"]["robot"] == name])
                    for name in robots} | {"all": _rates_of_several(every)},
    }  # fmt: skip


def _rates_of_several(rows: Sequence[Row]) -> dict[str, Any]:
    mine = [r for r in rows if is_of_several(r)]
    return {
        "all_found": rate(mine, lambda r: count_found(r) == len(r["truth"]["acting"])),
        "most_found": rate(mine, lambda r: count_found(r) >= len(r["truth"]["acting"]) - 1),
        "false_name": rate(mine, has_false_name),
        "all_said": rate(mine, is_all_said),
        "drawn": rate(mine, lambda r: any(n["name"].startswith("curve_") for n in r["named"])),
        "worse_than_fit": rate(mine, is_worse),
    }


def _rates_of_unlisted(rows: Sequence[Row]) -> dict[str, Any]:
    mine = [r for r in rows if is_unlisted(r)]
    return {
        "law_named": rate(mine, is_law_named),
        "law_refused": rate(mine, lambda r: bool(refused(r))),
        "drawn": rate(mine, is_drawn),
        "drawn_over_cause": rate(
            [r for r in mine if r["truth"]["curve"] != "-"], is_drawn_over_its_cause
        ),
        "unknown": rate(mine, is_unknown),
        "drawn_or_unknown": rate(mine, lambda r: is_drawn(r) or is_unknown(r)),
        "missed": rate(mine, lambda r: r["verdict"] == "nothing missing"),
        "worse_than_fit": rate(mine, is_worse),
    }


def _rates(rows: Sequence[Row]) -> dict[str, Any]:
    rows = [r for r in rows if not is_unlisted(r)]
    hidden = [r for r in rows if not is_null(r)]
    right = [r for r in hidden if is_right(r)]
    return {
        "right_first": rate(hidden, is_right),
        "right_or_alike": rate(hidden, is_right_or_alike),
        "wrong_first": rate(hidden, lambda r: bool(r["named"]) and not is_right(r)),
        "right_refused": rate(hidden, lambda r: bool(refused(r) & right_names(r))),
        "further_names": rate(right, lambda r: len(r["named"]) > 1),
        "place_right": rate([r for r in right if r["truth"]["places"]], is_placed),
        "null_silent": rate([r for r in rows if is_null(r)], lambda r: not r["named"]),
        "worse_than_fit": rate(rows, is_worse),
        "fit_worse_than_written": rate(rows, is_fit_worse),
        "processor_seconds": median([r["processor_seconds"] for r in rows]),
        "longest": max((r["processor_seconds"] for r in rows), default=None),
    }


def confusion(rows: Sequence[Row]) -> dict[str, dict[str, int]]:
    """First names and verdicts by what was hidden."""
    counts: dict[str, Counter[str]] = {}
    for row in rows:
        counts.setdefault(row["truth"]["effect"], Counter())[first(row)] += 1
    return {true: dict(counts[true].most_common()) for true in sorted(counts)}


def reliability(rows: Sequence[Row]) -> dict[str, dict[str, Any]]:
    """How many first names are right, by the confidence with which they are said.

    A curve is no name. Where a force is in no catalogue every name is wrong.
    """
    named = [r for r in rows if r["named"] and not first(r).startswith("curve_")]
    out = {}
    for low, high in pairwise(BANDS):
        mine = [r for r in named if low <= r["named"][0]["confidence"] < high]
        out[f"{100 * low:.0f} to {100 * high:.0f} %"] = rate(mine, is_right)
    return out
