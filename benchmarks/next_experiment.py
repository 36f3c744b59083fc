"""How often a designed second record ends a set of rivals, and how often a random one does; rows.

    python benchmarks/next_experiment.py [--robot pendulum] [--effect hardening] [--count 3]
    python benchmarks/next_experiment.py --only-page           what the rows come to

Each hidden world (`joint_worlds`) is searched on one record, which takes half of the robot's travel
and speed. Where the answer is a set of names, the right one among them and a wrong one too, the
next experiment is designed within twice the range of that record, recorded in the world, and both
records are searched. A random motion within the same limits (the median of those that the design
tried) is recorded and searched likewise. A finished world is one line of RESULTS.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from joint_worlds.files import truth_of, write_csv, write_world
from joint_worlds.hidden import HIDDEN
from joint_worlds.motion import ROBOTS
from joint_worlds.world import UnseenError, World, further_record, make_world
from rows import Row, answered, of_newest, rows_of

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "next_experiment.jsonl"
REACH, WIDEN = 0.5, 0.5  # of the first record; by which its range is widened: twice as far
SECONDS = 8.0  # of each record
BUDGET = 40


def study(robot: str, effect: str, seed: int) -> dict[str, Any]:
    """One world: its first answer, and where that is a set, the answers after a second record."""
    from identification import design_experiment, discover, read_robot
    from identification.storage.results import RESULT, write_result

    try:
        world = make_world(robot, effect, seed, SECONDS, reach=REACH)
    except UnseenError as error:
        return {"unseen": str(error)}
    row: dict[str, Any] = {"truth": truth_of(world)}
    clock = time.perf_counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        toml, a, _ = write_world(world, folder)
        try:
            known = read_robot(toml, a)
            found = discover(known)
            record = found.to_dict()
            row["first"] = _told(record)
            row["is_set"] = _is_set(record, world)
            if row["is_set"]:
                out = folder / "out"
                out.mkdir()
                found.files.keep(out, out)
                write_result(out / RESULT, None, record)
                row |= _second(world, toml, a, out, design_experiment(
                    known, out, seconds=SECONDS, widen=WIDEN, form="reference", budget=BUDGET
                ))  # fmt: skip
        except Exception as error:
            row["error"] = f"{type(error).__name__}: {error}"
    return {**row, "seconds": time.perf_counter() - clock}


def _second(world: World, toml: Path, a: Path, out: Path, designed: Any) -> dict[str, Any]:
    """The answers of a search with the designed record, and with a random one."""
    from identification import discover, read_robot

    found = designed.found
    row: dict[str, Any] = {
        "hypotheses": [h.name for h in found.hypotheses], "shares": list(found.shares),
        "shares_after": found.shares_after.tolist(),
        "log_odds": 0.5 * float(found.best.separations.min()),
        "random_log_odds": 0.5 * float(found.random.separations.min()),
        "margin": found.best.played.margins[0].share,
    }  # fmt: skip
    for word, tried in (("designed", found.best), ("random", found.random)):
        further = further_record(world, tried.played.aim, 1)
        b = out.parent / f"{word}.csv"
        write_csv(b, world.robot, further.inputs, further.outputs)
        record = discover(read_robot(toml, [a, b])).to_dict()
        row[word] = _told(record)
        row[f"{word}_ends"] = _ends(record, world)
    return row


def _told(record: Mapping[str, Any]) -> list[Any]:
    """The names, whether each is one of a set, and its rivals."""
    return [
        [e["name"], e["where"], e["confidence"], e["one_of"],
         [[r["name"], r["where"], r["confidence"]] for r in e["rivals"]]]
        for e in record["effects"]
    ]  # fmt: skip


def _is_set(record: Mapping[str, Any], world: World) -> bool:
    """Whether a search ended with a set of names, of which one is right and another is wrong."""
    for e in record["effects"]:
        if e["one_of"]:
            right = {n["name"] in world.names for n in (e, *e["rivals"])}
            if right == {True, False}:
                return True
    return False


def _ends(record: Mapping[str, Any], world: World) -> bool:
    """Whether a search names the right effect, and no set."""
    sure = [e["name"] for e in record["effects"] if not e["one_of"]]
    return len(sure) == len(record["effects"]) and bool({*sure} & {*world.names})


def told(row: Row) -> str:
    """A row in a line."""
    if "first" not in row:
        return f"{row['key']}: {row.get('unseen') or row['error']}"
    names = [
        e[0] + (" or " + " or ".join(r[0] for r in e[4]) if e[3] else "") for e in row["first"]
    ]
    after = "".join(
        f"; {word}: {' + '.join(e[0] + (' or …' if e[3] else '') for e in row[word]) or 'nothing'}"
        for word in ("designed", "random") if word in row
    )  # fmt: skip
    return f"{row['key']}: {' + '.join(names) or 'nothing'}{after} {row.get('error', '')}"


def summary(rows: list[Row]) -> str:
    """What the rows come to."""
    sets = [r for r in rows if r.get("is_set")]
    done = [r for r in sets if "random_ends" in r]
    odds = [r["log_odds"] for r in done]
    lines = [
        f"{len(rows)} worlds, {len(sets)} with a set of rivals, {len(done)} with a second record"
    ]
    lines += [f"{word}: ended {sum(r[f'{word}_ends'] for r in done)} of {len(done)}"
              for word in ("designed", "random")]  # fmt: skip
    if odds:
        better = np.median([r["log_odds"] - r["random_log_odds"] for r in done])
        lines.append(f"expected log odds {np.median(odds):.3g}, {better:.3g} more than random")
    return "\n".join(lines)


def main() -> int:
    """Run what is not done, and print what the rows come to."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("--robot", nargs="+", choices=list(ROBOTS), default=["pendulum", "cart"])
    add("--effect", nargs="+", choices=list(HIDDEN), default=list(HIDDEN))
    add("--count", type=int, default=1, help="worlds for each effect")
    add("--seed", type=int, default=1)
    add("--processes", type=int, default=1)
    add("--only-page", action="store_true")
    given = parser.parse_args()
    tasks = {
        f"{robot}/{effect}/{given.seed + k}": (robot, effect, given.seed + k)
        for k in range(given.count) for effect in given.effect for robot in given.robot
        if HIDDEN[effect].joints(ROBOTS[robot])
    }  # fmt: skip
    if not given.only_page:
        answered(study, tasks, RESULTS, told, given.processes)
    rows = rows_of(RESULTS)
    print(summary(of_newest(rows)) if rows else "no rows yet")
    return 0


if __name__ == "__main__":
    sys.exit(main())
