"""What the passes of a search are worth: hidden worlds answered with and without some of them.

    python benchmarks/ablation.py [--robot pendulum cart] [--count 4] [--without begin_anew ...]
    python benchmarks/ablation.py --effect three --without add_set set_for_effects
    python benchmarks/ablation.py --without plain       all passes at once but the forward selection
    python benchmarks/ablation.py --only-summary

Each world of `benchmarks/joint_worlds` is answered by the whole search and by one that leaves out
the passes, the two after each other in one process. A pair of answers is a line of
RESULTS/NAME.jsonl, where NAME says what is left out, and is not made again. The rates are those of
`joint_statistics`; a change is judged by the worlds that only one of the two answers right
(McNemar 1947: under no difference each of them is as likely as the other).
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hidden_joints import study
from joint_statistics import (
    count_found,
    has_false_name,
    is_law_named,
    is_null,
    is_of_several,
    is_right_or_alike,
    is_unlisted,
)
from joint_worlds.hidden import NULL, THREE, effects_of
from joint_worlds.motion import ROBOTS
from scipy.stats import binomtest

from identification.discovery.passes import PASSES
from identification.sweep.statistics import rate, said
from identification.sweep.work import commit

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "ablation"
PLAIN = "plain"  # the search with all passes left out; it adds one effect after another
Row = Mapping[str, Any]


def passes_of(names: Sequence[str]) -> tuple[str, ...]:
    """Returns the passes that are left out."""
    return tuple(PASSES) if PLAIN in names else tuple(names)


def is_good(row: Row) -> bool:
    """Whether an answer is right.

    A null stays silent, an unlisted force gets no law's name, and several effects are all named.
    """
    if is_of_several(row):
        return count_found(row) == len(row["truth"]["acting"]) and not has_false_name(row)
    if is_null(row):
        return bool(row["verdict"] == "nothing missing")
    return not is_law_named(row) if is_unlisted(row) else is_right_or_alike(row)


KINDS: Mapping[str, Callable[[Row], bool]] = {
    "nothing is missing: silent": is_null,
    "a listed effect: named first, or alike": lambda r: (
        not (is_null(r) or is_unlisted(r) or is_of_several(r))
    ),
    "three effects: all named, and no other": is_of_several,
    "a force in no catalogue: no law named": is_unlisted,
}


def summary(pairs: Sequence[Row]) -> str:
    """Returns a table: rates with and without the passes, and the chance of the difference."""
    done = [p for p in pairs if all("verdict" in p[which] for which in ("with", "without"))]
    lines = [
        "| worlds | with | without | only with | only without | chance |",
        "|---|---|---|---|---|---|",
    ]
    for kind, belongs in KINDS.items():
        mine = [p for p in done if belongs(p["with"])]
        each = [[is_good(p[which]) for p in mine] for which in ("with", "without")]
        only = [sum(a and not b for a, b in zip(*way, strict=True)) for way in (each, each[::-1])]
        chance = binomtest(only[0], sum(only)).pvalue if sum(only) else 1.0
        rates = [said(rate(column, bool)) for column in each]
        lines.append(f"| {kind} | {rates[0]} | {rates[1]} | {only[0]} | {only[1]} | {chance:.2g} |")
    spent = [sum(p[which]["processor_seconds"] for p in done) for which in ("with", "without")]
    made = Counter(move for p in done for move in {*p["with"]["moves"]})
    told = ", ".join(f"{name} in {count}" for name, count in made.most_common())
    return "\n".join([
        *lines, "",
        f"Of {len(done)} worlds, with {spent[0]:.0f} s and without {spent[1]:.0f} s of processor"
        f" time. Moves of the whole search that changed the effects: {told or 'none'}.",
    ])  # fmt: skip


def tasks(
    robots: Sequence[str], effects: Sequence[str], count: int, seed: int
) -> list[tuple[str, str, int]]:
    """Returns robots, effects and seeds, every effect once before any twice."""
    return [
        (robot, effect, seed + k)
        for k in range(count)
        for robot in robots
        for effect in (NULL, THREE, *effects_of(ROBOTS[robot]))
        if not effects or effect in effects
    ]


def pairs_of(path: Path) -> list[Row]:
    """Returns the pairs of answers that are kept."""
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def main() -> int:
    """Answer the worlds that are not answered yet, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--robot", nargs="+", choices=list(ROBOTS), default=["pendulum", "cart"])
    add("--effect", nargs="+", default=[], help="of the project's names, nothing, or three")
    add("--count", type=int, default=4, help="worlds for each effect, and as many nulls")
    add("--seed", type=int, default=1000)
    add("--duration", type=float, default=12.0, help="of a record [s]")
    add("--without", nargs="+", choices=[PLAIN, *PASSES], default=[PLAIN], metavar="PASS")
    add("--out", type=Path, default=RESULTS)
    add("--only-summary", action="store_true")
    given = parser.parse_args()
    path = given.out / f"{'+'.join(given.without)}.jsonl"
    path.parent.mkdir(parents=True, exist_ok=True)
    done = {p["key"] for p in pairs_of(path)}
    for robot, effect, seed in (
        [] if given.only_summary else tasks(given.robot, given.effect, given.count, given.seed)
    ):
        key = f"{robot}/{effect}/{seed}"
        if key in done:
            continue
        each = {
            which: study(robot, effect, seed, "records", given.duration, passes)
            for which, passes in (("with", ()), ("without", passes_of(given.without)))
        }
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"key": key, "commit": commit(), **each}) + "\n")
        print(
            key, *(each[w].get("verdict", "no answer") for w in each), file=sys.stderr, flush=True
        )
    print(summary(pairs_of(path)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
