"""How often a discovery is wrong in worlds outside the class of its models; rows, rates, a page.

    python benchmarks/wrong_worlds.py [--count 4] [--departure jumps ...] [--processes 2]
    python benchmarks/wrong_worlds.py --only-page             the page anew, from the rows

Each departure (`departures`) makes worlds of INCA as built, along a free run, and of a pendulum, a
cart and a two-link arm, over a horizon. Every other world hides nothing, except where a departure
is itself what is hidden. Each world has a seed of its own. An answer is a line of RESULTS with the
commit that gave it, and is not made again; the page counts the rows of the newest commit only.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from departures import DEPARTURES, Departure
from rows import Row, answered, of_newest, rows_of, write_part

from identification.sweep.statistics import rate, said

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "wrong_worlds.jsonl"
PAGE = HERE.parent / "docs" / "when_wrong.md"
BEGIN, END = "<!-- wrong worlds: begin -->\n", "<!-- wrong worlds: end -->\n"
INCA = "inca"
ROBOTS = ("pendulum", "cart", "two_link")  # of joints; an arm of six takes an hour a world
FIRST_SEED = 7_000_000
DURATION = {INCA: 10.0, "pendulum": 12.0, "cart": 12.0, "two_link": 12.0}  # of a record [s]
# What `powers` hides in robots of joints: a power of their laws is free.
WITH_POWERS = ("sublinear_friction", "stribeck_friction")


def tasks(departures: Sequence[str], count: int) -> list[tuple[str, str, bool, int]]:
    """Returns departure, robot, whether nothing is hidden, and seed, no departure twice before all.

    INCA and robots of joints alternate, and of each so do worlds that hide nothing or something.
    """
    out = []
    for k in range(count):
        robot = INCA if k % 2 == 0 else ROBOTS[k // 2 % len(ROBOTS)]
        for n, name in enumerate(DEPARTURES):
            is_null = DEPARTURES[name].hides == "listed" and k // 2 % 2 == 0
            if name in departures:
                out.append((name, robot, is_null, FIRST_SEED + 1000 * n + k))
    return out


def key_of(departure: str, robot: str, is_null: bool, seed: int) -> str:
    """Returns what tells a row from others."""
    return f"{departure}/{robot}/{'nothing' if is_null else 'something'}/{seed}"


def study(departure: str, robot: str, is_null: bool, seed: int) -> dict[str, Any]:
    """Returns a row: a world from its making to its answer; an error is a row too.

    Args:
        departure: its name.
        robot: its name.
        is_null: whether nothing is hidden.
        seed: of the world.
    """
    from joint_worlds.world import UnseenError

    from identification.errors import InputError

    row: dict[str, Any] = {"departure": departure, "robot": robot, "is_null": is_null}
    begin = time.process_time()
    ask = inca if robot == INCA else joints
    try:
        row |= ask(DEPARTURES[departure], robot, is_null, seed)
    except UnseenError as error:
        row["unseen"] = str(error)
    except InputError as error:
        row["refused"] = str(error)
    except Exception as error:
        row |= {"error": f"{type(error).__name__}: {error}",
                "trace": traceback.format_exc(limit=-4)}  # fmt: skip
    return {**row, "processor_seconds": time.process_time() - begin}


def inca(departure: Departure, robot: str, is_null: bool, seed: int) -> dict[str, Any]:
    """Returns truth and answer of a world of INCA; half of its log is fitted."""
    from inca_departures import make_inca

    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    log, truth = make_inca(departure, is_null, seed, DURATION[robot])
    found = discover([log], settled=True, spread=spread_of("usual"))
    return {"truth": truth, **answer(found)}


def joints(departure: Departure, robot: str, is_null: bool, seed: int) -> dict[str, Any]:
    """Returns truth and answer of a world of joints; one record is fitted, another confirms."""
    from joint_worlds.files import truth_of, write_world
    from joint_worlds.hidden import HIDDEN, NULL, UNLISTED, effects_of
    from joint_worlds.motion import ROBOTS as EVERY
    from joint_worlds.world import UnseenError, make_world

    from identification import read_robot
    from identification.prediction.discovery import discover_records

    kind = {"listed": HIDDEN, "unlisted": UNLISTED, "powers": WITH_POWERS}
    known = [e for e in effects_of(EVERY[robot]) if e in kind.get(departure.hides, ())]
    is_plain = is_null or departure.hides == "jumps"  # a jump is made of no effect of the catalogue
    order = [NULL] if is_plain else np.random.default_rng([seed, 17]).permutation(known).tolist()
    world = None
    for effect in order:  # the first that shows
        try:
            world = make_world(robot, effect, seed, DURATION[robot], departure)
            break
        except UnseenError as error:
            refused = error
    if world is None:
        raise refused
    with tempfile.TemporaryDirectory() as folder:
        toml, a, b = write_world(world, Path(folder))
        asked = read_robot(toml, a, confirm=[b])
        found = discover_records(asked.nominal_model, [asked.log], asked.records, asked.candidates)
    truth = truth_of(world)
    names = () if departure.hides == "unlisted" or is_null else world.names
    return {"truth": {**truth, "names": list(names)}, **answer(found)}


def answer(found: Any) -> dict[str, Any]:
    """Returns what a discovery says."""
    return {
        "verdict": found.verdict, "unexplained": bool(found.unexplained),
        "named": [
            {"name": n.name, "where": n.where, "confidence": float(n.confidence),
             "one_of": bool(n.one_of), "rivals": [r.name for r in n.rivals]}
            for n in found.named
        ],
        "findings": [f.kind.value for f in found.findings],
        "before": float(found.before.rms), "after": float(found.after.rms),
    }  # fmt: skip


def laws(row: Row) -> list[Mapping[str, Any]]:
    """Returns the names that are laws; a curve says where something acts and not what."""
    return [n for n in row["named"] if not n["name"].startswith("curve_")]


def is_false(row: Row) -> bool:
    """A law is named that does not act; one of a set of two may."""
    true = set(row["truth"]["names"])
    return any(not true & {n["name"], *n["rivals"][: int(n["one_of"])]} for n in laws(row))


def is_right(row: Row) -> bool:
    """The first name is one that acts, or in a set of two with it, and no other name is false."""
    return bool(laws(row)) and not is_false(row)


def is_unknown(row: Row) -> bool:
    """No law is named, and something is said to be missing."""
    return not laws(row) and row["verdict"] != "nothing missing"


def is_silent(row: Row) -> bool:
    """Nothing is said to be missing."""
    return bool(row["verdict"] == "nothing missing")


COLUMNS: tuple[tuple[str, bool, Callable[[Row], bool]], ...] = (
    ("nothing hidden: silent", True, is_silent),
    ("unknown", True, is_unknown),
    ("a false name", True, is_false),
    ("something hidden: right", False, is_right),
    ("unknown", False, is_unknown),
    ("missed", False, is_silent),
    ("a false or wrong name", False, is_false),
)


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Returns the rates of what the issue of such worlds is: names and nulls."""
    nulls = [r for r in rows if r["is_null"]]
    return {
        "worlds": len(rows), "false_or_wrong": rate(rows, is_false),
        "unknown_on_null": rate(nulls, is_unknown),
        "by_departure": {
            name: [rate([r for r in rows if r["departure"] == name and r["is_null"] is null], test)
                   for _, null, test in COLUMNS]
            for name in DEPARTURES
        },
    }  # fmt: skip


def section(rows: Sequence[Row]) -> str:
    """Returns the part of the page, from rows of one commit."""
    done = [r for r in rows if "verdict" in r]
    found = summary(done)
    lines = [
        "## Worlds outside the class of models",
        "",
        "These simulated worlds violate what a search takes for granted, each in one way",
        "(`benchmarks/departures.py`). Half of them are INCA as built, 10 s along a free run; the",
        "others are a pendulum, a cart and a two-link arm over a horizon. Every other world hides",
        "nothing, except where the violation is itself what is hidden. A name is false if no such",
        "law acts. A curve does not count as a name.",
        "",
        "    python benchmarks/wrong_worlds.py --processes 2",
        "",
    ]
    if not done:
        return "\n".join([*lines, "The present search has not answered any of them yet.", ""])
    words = {"refused": "refused", "error": "ended with an error",
             "unseen": "not made because too little shows"}  # fmt: skip
    rest = [f"{sum(w in r for r in rows)}{' were' * (w != 'error')} {said_so}"
            for w, said_so in words.items()]  # fmt: skip
    lines += [
        f"Of {len(done)} worlds (commit {done[-1]['commit']}; brackets are 95 % intervals)"
        f" {said(found['false_or_wrong'])} got a false name. Of those that hide nothing"
        f' {said(found["unknown_on_null"])} were called "unknown effect". Further worlds:'
        f" {', '.join(rest)}.",
        "",
        "| departure | " + " | ".join(name for name, _, _ in COLUMNS) + " |",
        "|---" * (1 + len(COLUMNS)) + "|",
    ]
    for name, rates in found["by_departure"].items():
        if any(r["of"] for r in rates):
            lines.append(f"| {DEPARTURES[name].about} | {' | '.join(said(r) for r in rates)} |")
    return "\n".join([*lines, ""])


def told(row: Row) -> str:
    """Returns a row in a line."""
    if "verdict" not in row:
        word = next(w for w in ("unseen", "refused", "error") if w in row)
        return f"{row['key']}: {word}, {row[word]}"
    names = " + ".join(f"{n['name']}, {n['where']}" for n in row["named"]) or row["verdict"]
    hidden = ", ".join(row["truth"]["names"]) or ("nothing" if row["is_null"] else "unlisted")
    return f"{row['key']}: {hidden} -> {names}; {row['processor_seconds']:.0f} s"


def main() -> int:
    """Answer the worlds that are not answered yet, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--count", type=int, default=4, help="worlds of each departure")
    add("--departure", nargs="+", choices=list(DEPARTURES), default=list(DEPARTURES))
    add("--robot", nargs="+", choices=[INCA, *ROBOTS], default=[INCA, *ROBOTS])
    add("--processes", type=int, default=1)
    add("--out", type=Path, default=RESULTS)
    add("--page", type=Path, default=PAGE)
    add("--only-page", action="store_true")
    given = parser.parse_args()
    some = {key_of(*t): t for t in tasks(given.departure, given.count) if t[1] in given.robot}
    rows = (
        rows_of(given.out) if given.only_page
        else answered(study, some, given.out, told, given.processes)
    )  # fmt: skip
    mine = of_newest(rows) if rows else []
    print(json.dumps(summary([r for r in mine if "verdict" in r])))
    write_part(given.page, BEGIN, END, section(mine))
    return 0


if __name__ == "__main__":
    sys.exit(main())
