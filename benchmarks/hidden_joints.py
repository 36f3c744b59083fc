"""How often a discovery names what a pendulum, a cart and two arms hide; rows, rates, a page.

    python benchmarks/hidden_joints.py [--robot pendulum] [--effect delay] [--count 3] [--seed 1]
                                       [--processes 2]
    python benchmarks/hidden_joints.py --only-page            the page anew, from the rows
    python benchmarks/hidden_joints.py --write FOLDER         worlds as files, without discovery

Each world (`joint_worlds`) is fitted on one record and judged on another. A finished world is one
line of RESULTS and is not done again by the same search. For every effect of a robot there are as
many worlds without any effect as `--nulls` says. The page is of one search (`rows`).
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
import traceback
from pathlib import Path
from typing import Any

from joint_page import section
from joint_statistics import summary
from joint_worlds.files import truth_of, write_world
from joint_worlds.hidden import NULL, THREE, effects_of
from joint_worlds.motion import ROBOTS
from joint_worlds.world import UnseenError, make_world
from rows import Row, answered, of_newest, rows_of, write_part

from identification.discovery.result import Discovery

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "hidden_joints.jsonl"
PAGE = HERE.parent / "docs" / "benchmarks.md"
BEGIN, END = "<!-- hidden joints: begin -->\n", "<!-- hidden joints: end -->\n"


def study(
    robot: str, effect: str, seed: int, duration: float, without: tuple[str, ...] = ()
) -> dict[str, Any]:
    """One world from its making to its answer; an error is a row too."""
    try:
        world = make_world(robot, effect, seed, duration)
    except UnseenError as error:
        return {"unseen": str(error)}
    row: dict[str, Any] = {"truth": truth_of(world), "duration": duration}
    begin, wall = time.process_time(), time.perf_counter()
    try:
        with tempfile.TemporaryDirectory() as folder:
            row |= answer(*write_world(world, Path(folder)), without)
    except Exception as error:
        row |= {"error": f"{type(error).__name__}: {error}",
                "trace": traceback.format_exc(limit=-4)}  # fmt: skip
    return {**row, "processor_seconds": time.process_time() - begin,
            "seconds": time.perf_counter() - wall}  # fmt: skip


def answer(toml: Path, a: Path, b: Path, without: tuple[str, ...] = ()) -> dict[str, Any]:
    """What is named, and the errors on record b of what was fitted and of what was found."""

    from identification import DiscoveryOptions, discover, fit, read_robot
    from identification.robot.results.confirmation import compare_values

    robot = read_robot(toml, a, confirm=[b])
    options = DiscoveryOptions(without=without)
    begin = time.process_time()
    fitted = fit(robot).values
    between = time.process_time()
    found = discover(robot, options=options)
    end = time.process_time()
    own = found.final.own_values.get(robot.records[0].name, {})
    after = {**found.final.values, **own}  # with what the other record has for itself
    error = compare_values(robot, robot.records[0], fitted, after)
    written = compare_values(robot, robot.records[0], {}, {})
    return {
        **answer_of(found),
        "errors": {"written": written.before, "fit": error.before, "discover": error.after},
        "fitted": fitted, "fit_seconds": between - begin, "discover_seconds": end - between,
    }  # fmt: skip


def answer_of(found: Discovery) -> dict[str, Any]:
    """Returns what a search says, as a row has it."""
    return {
        "verdict": found.verdict, "moves": list(found.moves),
        "named": [
            {"name": n.candidate.effect.name, "where": n.candidate.where,
             "confidence": n.confidence, "one_of": n.one_of,
             "same_as": n.same_as.name if n.same_as else None,
             "rivals": [rival.name for rival in n.rivals],
             "shares": [rival.confidence for rival in n.rivals],
             "smooth_share": n.smooth_share,
             "neighbour": (b := n.neighbour) and [b.curve, b.where, b.share, b.chance, b.of_both],
             "compared": n.compared, "fall": n.proof.fall,
             "t": n.proof.t,
             "sizes": {name: p[0] for name, p in n.parameters.items()}}
            for n in found.named
        ],
        "smooth_share": found.smooth_share, "unexplained": found.unexplained,
        "input_error": found.input_error, "times_noise": found.times_noise(found.after),
        "curves": [[s.candidate.effect.name, s.candidate.where, float(s.fall), float(s.p_value)]
                   for s in found.remaining if s.candidate.effect.is_curve],
        "findings": [f.kind.value for f in found.findings],
        "rejected": [[r.candidate.effect.name, r.candidate.where, r.doubt] for r in found.rejected],
        "scores": [[s.candidate.effect.name, s.candidate.where] for s in found.scores[:5]],
    }  # fmt: skip


def tasks(given: argparse.Namespace) -> list[tuple[str, str, int]]:
    """Robots, effects and seeds that are asked for, every effect once before any twice."""
    out = []
    for k in range(max(given.count, given.nulls)):
        for robot in given.robot or ROBOTS:
            effects = given.effect or (NULL, THREE, *effects_of(ROBOTS[robot]))
            out += [(robot, e, given.seed + k) for e in effects
                    if k < (given.nulls if e == NULL else given.count)]  # fmt: skip
    return out


def told(row: Row) -> str:
    """A row in a line."""
    if "verdict" not in row:
        return f"{row['key']}: {row.get('unseen') or row['error']}"
    named = " + ".join(f"{n['name']}, {n['where']}" for n in row["named"]) or row["verdict"]
    errors = ", ".join(f"{word} {value:.3g}" for word, value in row["errors"].items())
    where = row["truth"]["joint"]
    return f"{row['key']} {where}: {named}; {errors}; {row['processor_seconds']:.0f} s"


def main() -> int:
    """Run what is not done, print the rates, write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("--robot", nargs="+", choices=list(ROBOTS), default=[])
    add("--effect", nargs="+", default=[], help="of the project's names, or 'nothing'")
    add("--count", type=int, default=1, help="worlds for each effect")
    add("--nulls", type=int, default=None, help="worlds without effect; as --count if not given")
    add("--seed", type=int, default=1)
    add("--duration", type=float, default=20.0, help="of a record [s]")
    add("--processes", type=int, default=1)
    add("--out", type=Path, default=RESULTS)
    add("--page", type=Path, default=PAGE)
    add("--again", action="store_true", help="do worlds again that met an error")
    add("--only-page", action="store_true")
    add("--write", type=Path, help="a folder for the worlds; nothing is discovered")
    given = parser.parse_args()
    given.nulls = given.count if given.nulls is None else given.nulls
    known = {NULL, THREE, *(e for r in ROBOTS.values() for e in effects_of(r))}
    if unknown := set(given.effect) - known:
        print(f"unknown effect {min(unknown)!r}; known: {', '.join(sorted(known))}",
              file=sys.stderr)  # fmt: skip
        return 2
    asked = {
        f"{robot}/{effect}/{seed}": (robot, effect, seed, given.duration)
        for robot, effect, seed in tasks(given)
        if effect in (NULL, THREE) or effect in effects_of(ROBOTS[robot])
    }
    if given.write is not None:
        for robot, effect, seed, *_ in asked.values():
            try:
                folder = given.write / f"{robot}_{effect}_{seed}"
                write_world(make_world(robot, effect, seed, given.duration), folder)
                print(folder, flush=True)
            except UnseenError as error:
                print(f"{robot}/{effect}/{seed}: {error}", flush=True)
        return 0
    rows = (
        rows_of(given.out) if given.only_page
        else answered(study, asked, given.out, told, given.processes, given.again)
    )  # fmt: skip
    mine = of_newest(rows) if rows else []
    print(json.dumps(summary(mine)))
    write_part(given.page, BEGIN, END, section(mine))
    return 0


if __name__ == "__main__":
    sys.exit(main())
