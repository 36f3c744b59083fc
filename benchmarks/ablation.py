"""What the passes of a search are worth: hidden worlds answered with and without some of them.

    python benchmarks/ablation.py --without weak_scores [--robot pendulum cart] [--processes 2]
    python benchmarks/ablation.py --without add_set set_for_effects --moved
    python benchmarks/ablation.py --without plain       all passes at once but the forward selection
    python benchmarks/ablation.py --only-page       the page anew, from the rows

Each world that `hidden_joints.py` has answered with the present search is answered anew by one that
leaves out the passes. Such an answer is a line of RESULTS/NAME.jsonl, where NAME says what is left
out, and is not made again by the same search. The rates are those of `joint_statistics`; a change
is judged by the worlds that only one of the two answers right (McNemar 1947: under no difference
each of them is as likely as the other). The page has a table for each NAME.

`--moved` is for moves: a world in which none of those that are left out changed the effects is
answered alike without them, and is not searched again.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import hidden_joints
from joint_statistics import (
    count_found,
    has_false_name,
    is_law_named,
    is_null,
    is_of_several,
    is_right_or_alike,
    is_unlisted,
)
from joint_worlds.motion import ROBOTS
from rows import answered, of_newest, rows_of, write_part
from scipy.stats import binomtest

from identification.discovery.passes import PASSES
from identification.sweep.statistics import rate, said

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "ablation"
BEGIN, END = "<!-- ablation: begin -->\n", "<!-- ablation: end -->\n"
PLAIN = "plain"  # the search with all passes left out; it adds one effect after another
WHICH = ("with", "without")
Row = Mapping[str, Any]


def passes_of(names: Sequence[str]) -> tuple[str, ...]:
    """Returns the passes that are left out."""
    return tuple(PASSES) if PLAIN in names else tuple(names)


def is_good(row: Row) -> bool:
    """Whether an answer is right.

    A null stays silent, an unlisted force is not missed and gets no law's name, and several effects
    are all named.
    """
    if is_of_several(row):
        return count_found(row) == len(row["truth"]["acting"]) and not has_false_name(row)
    if is_null(row):
        return bool(row["verdict"] == "nothing missing")
    if is_unlisted(row):
        return row["verdict"] != "nothing missing" and not is_law_named(row)
    return is_right_or_alike(row)


KINDS: Mapping[str, Callable[[Row], bool]] = {
    "nothing is missing: silent": is_null,
    "a listed effect: named first, or alike": lambda r: (
        not (is_null(r) or is_unlisted(r) or is_of_several(r))
    ),
    "three effects: all named, and no other": is_of_several,
    "a force in no catalogue: drawn, or unknown": is_unlisted,
}


def summary(pairs: Sequence[Row]) -> str:
    """Returns a table: rates with and without the passes, and the chance of the difference."""
    done = [p for p in pairs if all("verdict" in p[which] for which in WHICH)]
    lines = [
        "| worlds | with | without | only with | only without | chance |",
        "|---|---|---|---|---|---|",
    ]
    for kind, belongs in KINDS.items():
        mine = [p for p in done if belongs(p["with"])]
        each = [[is_good(p[which]) for p in mine] for which in WHICH]
        only = [sum(a and not b for a, b in zip(*way, strict=True)) for way in (each, each[::-1])]
        chance = binomtest(only[0], sum(only)).pvalue if sum(only) else 1.0
        rates = [said(rate(column, bool)) for column in each]
        lines.append(f"| {kind} | {rates[0]} | {rates[1]} | {only[0]} | {only[1]} | {chance:.2g} |")
    spent = [sum(p[which]["processor_seconds"] for p in done) for which in WHICH]
    made = Counter(move for p in done for move in {*p["with"]["moves"]})
    told = ", ".join(f"{name} in {count}" for name, count in made.most_common())
    return "\n".join([
        *lines, "",
        f"Of {len(done)} worlds, with {spent[0]:.0f} s and without {spent[1]:.0f} s of processor"
        f" time. Moves of the whole search that changed the effects: {told or 'none'}.",
    ])  # fmt: skip


def study(answer: Row, passes: tuple[str, ...], is_moved: bool) -> dict[str, Any]:
    """Returns a world's answer by a search without the passes.

    Args:
        answer: row of the whole search.
        passes: that are left out.
        is_moved: whether a world in which none of them changed the effects is answered alike.
    """
    robot, effect, seed = answer["key"].split("/")
    if is_moved and not {*passes} & {*answer["moves"]}:
        return {**answer, "alike": True}
    return hidden_joints.study(robot, effect, int(seed), answer["duration"], passes)


def told(row: Row) -> str:
    """A row in a line."""
    return f"{row['key']} {row.get('verdict', 'no answer')}"


def pairs_of(answers: Sequence[Row], rows: Sequence[Row]) -> list[Row]:
    """Returns answers of the whole search, each with that of the search without passes.

    Args:
        answers: of the whole search.
        rows: of the search without passes.
    """
    whole = {row["key"]: row for row in of_newest(answers)} if answers else {}
    mine = [row for row in rows if row["key"] in whole]
    return [
        {"with": whole[row["key"]], "without": row}
        for row in mine if row["commit"] == whole[row["key"]]["commit"]
    ]  # fmt: skip


def section(answers: Sequence[Row], folder: Path) -> str:
    """The section of the page, Markdown.

    Args:
        answers: of the whole search.
        folder: of the rows of searches without passes.
    """
    lines = ["## What passes of a search are worth", "",
             "    python benchmarks/ablation.py --without PASS", ""]  # fmt: skip
    tables = []
    for path in sorted(folder.glob("*.jsonl")):
        if pairs := pairs_of(answers, rows_of(path)):
            names = " and ".join(f"`{name}`" for name in path.stem.split("+"))
            tables.append(f"Without {names}, search of {pairs[-1]['with']['commit']}:\n\n"
                          f"{summary(pairs)}\n")  # fmt: skip
    return "\n".join([*lines, *(tables or ["None has been left out of the present search.\n"])])


def main() -> int:
    """Answer the worlds that are not answered yet, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--robot", nargs="+", choices=list(ROBOTS), default=["pendulum", "cart"])
    add("--effect", nargs="+", default=[], help="of the project's names, nothing, or three")
    add("--answers", type=Path, default=hidden_joints.RESULTS, help="of the whole search")
    add("--without", nargs="+", choices=[PLAIN, *PASSES], default=[PLAIN], metavar="PASS")
    add("--moved", action="store_true", help="only worlds in which one of the moves did something")
    add("--processes", type=int, default=1)
    add("--out", type=Path, default=RESULTS)
    add("--page", type=Path, default=hidden_joints.PAGE)
    add("--only-page", action="store_true")
    given = parser.parse_args()
    path = given.out / f"{'+'.join(given.without)}.jsonl"
    answers = rows_of(given.answers)
    asked = {
        row["key"]: (row, passes_of(given.without), given.moved)
        for row in (of_newest(answers) if answers else [])
        if "verdict" in row and row["truth"]["robot"] in given.robot
        and (not given.effect or row["truth"]["effect"] in given.effect)
    }  # fmt: skip
    if not given.only_page:
        answered(study, asked, path, told, given.processes)
        print(summary(pairs_of(answers, rows_of(path))))
    write_part(given.page, BEGIN, END, section(answers, given.out))
    return 0


if __name__ == "__main__":
    sys.exit(main())
