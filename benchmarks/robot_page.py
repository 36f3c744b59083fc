"""The page of robots in the manner of MuJoCo Menagerie: rates of right names, by kinds of worlds.

Rows are those of `robot_models`, an answer of a search each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from robot_worlds import NAMES, UNLISTED, UPRIGHT
from rows import Row

from identification.effects.laws.curves import CURVE
from identification.sweep.statistics import median, rate, said

NO_NAME = ("unlisted effect", "unknown effect")
NO_LAW = (*NO_NAME, "nothing missing")
CLOSE = 1e-3  # of a shift of clocks [s]
BINS = ((0.0, 0.5), (0.5, 0.8), (0.8, 0.9), (0.9, 1.1))  # of confidences
REFUSED = (
    ("it explains less than 92 % of what smooth forces could", "further"),
    ("a smooth force of a joint does as much", "smooth"),
)
WORDS = {
    "arm": "an arm with position servos",
    "finger": "a finger whose joints a tendon drives together",
    "leg": "a leg of a quadruped with PD drives",
    "four_bar": "a four-bar closed by a connect",
    "gripper": "a gripper whose fingers a joint equality couples",
    "crane": "a load on two tendons whose lengths are measured",
    "cart": "a cart with an end stop",
}
HEAD = """# Kinds of robots that were tried

`benchmarks/robot_models.py` makes this page. Each robot is a small model in the manner of MuJoCo
Menagerie (`examples/linkages`, `benchmarks/robots/kinds`), simulated with one effect or several
that its model lacks, each at a joint that is driven. No law is exact on a real robot: a *rough* one
also has at each driven joint 5 to 20 % of a force of position and rate that is in no catalogue. A
log of 8 s at 100 Hz is fitted and searched, another one confirms. The search tries all candidates.
An answer is right if each name is that of a hidden effect at its joint, and no effect is left
without one; what makes a robot rough must have no name, but a curve of the data may draw it. For
the four-bar and the gripper, whose joints are coupled, a name may also stand at another joint or at
all of them, because the motion cannot tell these apart. In a world of *two clocks* the inputs of
each record act up to 25 ms later or earlier than their stamps say, and each record has its own
time; a servo only comes late. Clocks that differ by less than 1 ms may be told as one `delay`.
"""


def is_right(row: Row) -> bool:
    """Returns whether the answer is as it should be: a name for each hidden effect, and no more.

    A force of no catalogue must be drawn or unknown, and so may what is hidden beside it.
    """
    named, hidden = _names(row), _hidden(row)
    if hidden and _is_rough(row) and not _has_unlisted(row):
        named = [n for n in named if not n["name"].startswith(CURVE)]
    if not hidden:
        return row.get("verdict") in (("nothing missing",) if not _is_rough(row) else NO_LAW)
    if _has_unlisted(row):
        is_a_name = row.get("verdict") == "named" and not is_wrong(row)
        return is_a_name or row.get("verdict") in NO_NAME
    return len(named) == len(hidden) and all(
        any(_is_meant(row, h, n["name"], n["where"]) for n in named) for h in hidden
    )


def is_wrong(row: Row) -> bool:
    """Returns whether a law is named that is not there, and no set of names has a right one."""
    if row.get("verdict") != "named":
        return False
    for n in _names(row):
        if n["name"].startswith(CURVE):
            continue
        every = [[n["name"], n["where"]], *([r[0], r[1]] for r in n["rivals"])]
        if not any(_is_meant(row, h, name, where) for h in _hidden(row) for name, where in every):
            return True
    return False


def _hidden(row: Row) -> list[tuple[str, str]]:
    """Returns what a world hides, each effect with its joint."""
    if row["effect"] == "nothing":
        return []
    return list(zip(row["effect"].split("+"), row["joint"].split("+"), strict=True))


def _names(row: Row) -> list[dict[str, Any]]:
    """Returns the names of an answer, but for what all clocks of a world are late by."""
    named = row.get("named") or []
    return [n for n in named if not (_are_alike(row) and n["name"] in NAMES["delay"])]


def _are_alike(row: Row) -> bool:
    """Returns whether two clocks stamp a world's records and hardly differ."""
    clocks = row.get("clocks") or []
    return bool(clocks) and max(clocks) - min(clocks) < CLOSE


def _is_rough(row: Row) -> bool:
    """Returns whether a world also has forces that no law describes at its driven joints."""
    return bool(row.get("rough"))


def _has_unlisted(row: Row) -> bool:
    """Returns whether a world hides a force of no catalogue."""
    return any(effect in UNLISTED for effect, _ in _hidden(row))


def _is_drawn(row: Row) -> bool:
    """Returns whether a curve of the data is told at the joint of what is hidden."""
    at = f"joint {row['joint']}"
    return any(n["name"].startswith(CURVE) and n["where"] == at for n in row.get("named") or [])


def _names_two(row: Row) -> bool:
    """Returns whether at least two of what is hidden are named, each at its joint."""
    each = [(n["name"], n["where"]) for n in row.get("named") or []]
    return sum(any(_is_meant(row, h, *n) for n in each) for h in _hidden(row)) > 1


def _tells_clocks(row: Row) -> bool:
    """Returns whether a shift of clocks is told."""
    return any(name == "time_shift" for name, *_ in row.get("differences") or [])


def _clocks_error(row: Row) -> float:
    """Returns by how much the told shifts of two records are wrong at most [s]; inf without any."""
    each = [values for name, _, values in row.get("differences") or [] if name == "time_shift"]
    told = [v for values in each for v in values.values()]
    if not told and _are_alike(row):
        late = [n for n in row.get("named") or [] if n["name"] in NAMES["delay"]]
        taus = [v for n in late for size, v in n["sizes"].items() if size.startswith("tau")]
        told = [float(np.mean(taus))] * len(row["clocks"]) if taus else []
    pairs = zip(told, row["clocks"], strict=False)
    return max(abs(a - b) for a, b in pairs) if len(told) == len(row["clocks"]) else np.inf


def _is_meant(row: Row, hidden: tuple[str, str], name: str, where: str) -> bool:
    """Returns whether a name at a place is one of what is hidden."""
    effect, joint = hidden
    is_upright = effect in ("load", "heavier") and (row["robot"], joint) in UPRIGHT
    names = (*NAMES[effect], *(NAMES["rotor"] if is_upright else ()))
    is_name = name.removeprefix("slide_") in names
    is_place = (
        row["robot"] in ("four_bar", "gripper")
        or not where.startswith(("joint", "all joints"))  # inputs and bodies have other names
        or joint in where
    )
    return is_name and is_place


def _names_of(rows: Sequence[Row]) -> list[tuple[float, bool]]:
    """Returns of each law that is named its confidence, and whether it is one of what is hidden."""
    return [
        (n["confidence"], any(_is_meant(row, h, n["name"], n["where"]) for h in _hidden(row)))
        for row in rows
        for n in _names(row)
        if row.get("verdict") == "named" and not n["name"].startswith(CURVE)
    ]


def _refused(rows: Sequence[Row], doubt: str) -> list[bool]:
    """Returns of each law that a doubt refused whether it is one of what is hidden."""
    return [
        any(_is_meant(row, h, name, where) for h in _hidden(row))
        for row in rows
        for name, where, why in row.get("rejected") or []
        if why == doubt and not name.startswith(CURVE)
    ]


def page(rows: Sequence[Row]) -> str:
    """Returns the page of the rows of one search."""
    kinds = [
        [r for r in rows if not (_is_rough(r) or r.get("clocks"))],
        [r for r in rows if _is_rough(r)],
        [r for r in rows if r.get("clocks")],
    ]
    lines = [HEAD, "| of all robots | nothing else is missing | rough | two clocks |",
             "|---|---|---|---|"]  # fmt: skip
    for what, chosen, is_hit in MEASURES:
        rates = (said(rate([r for r in kind if chosen(r)], is_hit)) for kind in kinds)
        lines.append(f"| {what} | {' | '.join(rates)} |")
    lines += ["", "| confidence of a name | right, of all names |", "|---|---|"]
    for low, high in BINS:
        some = [right for c, right in _names_of(rows) if low <= c < high]
        lines.append(f"| {low:g} to {min(1, high):g} | {said(rate(some, bool))} |")
    lines += ["", "| refused beside a surer law | was hidden there, of all refused |", "|---|---|"]
    for words, doubt in REFUSED:
        some = _refused(rows, doubt)
        lines.append(f"| {words} | {said(rate(some, bool))} |")
    lines += ["", "| robot | right | search, median [s] | what was not right |",
              "|---|---|---|---|"]  # fmt: skip
    for robot, words in WORDS.items():
        mine = [r for r in rows if r["robot"] == robot]
        if not mine:
            continue
        wrong = "; ".join(told(r) for r in mine if not is_right(r))
        middle = median([r["seconds"] for r in mine if "seconds" in r]) or 0.0
        hits = sum(map(is_right, mine))
        lines.append(f"| {words} | {hits} of {len(mine)} | {middle:.0f} | {wrong} |")
    return "\n".join(lines) + f"\n\nAll rows are of commit {rows[-1]['commit']}.\n"


# What a rate is of: its words, the rows that count, and when one of them is a hit.
MEASURES: Sequence[tuple[str, Callable[[Row], bool], Callable[[Row], bool]]] = (
    ("an effect of the catalogue is named, and nothing else",
     lambda r: bool(NAMES.get(r["effect"])), is_right),
    ("it is named, or is in the set of names that is told",
     lambda r: bool(NAMES.get(r["effect"])),
     lambda r: r.get("verdict") == "named" and not is_wrong(r)),
    ("of several effects all are named, each at its joint",
     lambda r: "+" in r["effect"] and not _has_unlisted(r), is_right),
    ("of several effects at least two are named",
     lambda r: "+" in r["effect"] and not _has_unlisted(r), _names_two),
    ("a law is named that is not there", lambda r: True, is_wrong),
    ("a force of no catalogue is drawn, or unknown", lambda r: r["effect"] in UNLISTED, is_right),
    ("it is drawn, at its joint", lambda r: r["effect"] in UNLISTED, _is_drawn),
    ("the same beside an effect of the catalogue, which may be named",
     lambda r: "+" in r["effect"] and _has_unlisted(r), is_right),
    ("nothing is named where nothing is missing, or nothing that has a name",
     lambda r: r["effect"] == "nothing", is_right),
    ("a shift of clocks is told that is not there", lambda r: not r.get("clocks"), _tells_clocks),
    ("the shifts of both records are told, to 1 ms", lambda r: bool(r.get("clocks")),
     lambda r: _clocks_error(r) < CLOSE),
    ("a search ends in an error", lambda r: True, lambda r: "error" in r),
)  # fmt: skip


def told(row: Row) -> str:
    """Returns what was said of a world, in a few words."""
    if "error" in row:
        return f"`{row['effect']}`: an error"
    names = " + ".join(f"`{n['name']}` at {n['where']}" for n in row["named"])
    where = f" at {row['joint']}" if row["joint"] else ""
    of = ", rough" if _is_rough(row) else ", two clocks" if row.get("clocks") else ""
    return f"`{row['effect']}`{where}{of}: {names or row['verdict']}"
