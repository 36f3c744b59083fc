"""What passes and options of a search over a horizon are worth: worlds answered without each pass.

    python benchmarks/ablation.py [--seed 1] [--count 2] [--processes 2]
    python benchmarks/ablation.py --passes signed_ranks own_weights --worlds leg pendulum
    python benchmarks/ablation.py --rough --worlds leg arm    robots with what no law describes
    python benchmarks/ablation.py --passes --options significance min_fall     each ± 50 %
    python benchmarks/ablation.py --only-page          the page anew, from the rows

Each world is answered by the search as it is, by one without each pass, and by one with each option
that is named half and one and a half times as large. All searches of a world keep their steps
(`kept_steps`), so that another one takes the time of what it does otherwise. Worlds are those of
`robot_models.py` and of `hidden_joints.py`. A finished world is a line of ROWS, and is not made
again by the same search.

A change is judged by the worlds that only one of the two searches answers right (McNemar 1947:
under no difference each of them is as likely as the other).
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import hidden_joints
import robot_models
import robot_page
from joint_statistics import (
    count_found,
    has_false_name,
    is_law_named,
    is_null,
    is_of_several,
    is_right_or_alike,
    is_unlisted,
)
from joint_worlds.files import truth_of, write_world
from joint_worlds.hidden import NULL, THREE, effects_of
from joint_worlds.motion import ROBOTS
from joint_worlds.world import UnseenError, make_world
from robot_motions import DRIVEN
from robot_worlds import NAMES, SEVERAL, is_asked, make, write
from rows import ROOT, Row, answered, of_newest, rows_of, write_part
from scipy.stats import binomtest

from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import HORIZON, PASSES

ROWS = ROOT / "benchmarks" / "results" / "ablation.jsonl"
PAGE = ROOT / "docs" / "benchmarks.md"
BEGIN, END = "<!-- ablation: begin -->\n", "<!-- ablation: end -->\n"
ASKED = tuple(name for name, (of, _) in PASSES.items() if of in (HORIZON, "both"))
SMALL = ("leg", "crane", "arm", "cart", "finger")  # kinds of robots whose search is short
JOINTS = ("pendulum",)  # of `hidden_joints`
DURATION = 10.0  # of a record of `hidden_joints` [s]
SHARES = (0.5, 1.5)  # of an option's value
NO_LIMIT = 1e4  # of the time of a search [min]
WHOLE = ""  # the search as it is


def variants(passes: Sequence[str], options: Sequence[str]) -> dict[str, DiscoveryOptions]:
    """Returns options of searches by their names; that of the search as it is comes first."""
    out = {WHOLE: DiscoveryOptions(max_minutes=NO_LIMIT)}
    for name in passes:
        out[name] = DiscoveryOptions(max_minutes=NO_LIMIT, without=(name,))
    plain = DiscoveryOptions()
    for name in options:
        for share in SHARES:
            value = type(getattr(plain, name))(share * getattr(plain, name))
            changed: dict[str, Any] = {"max_minutes": NO_LIMIT, name: value}
            out[f"{name} = {value:g}"] = DiscoveryOptions(**changed)
    return out


def is_good(row: Row) -> bool:
    """Returns whether an answer is right.

    A null stays silent, an unlisted force is not missed and gets no law's name, and several effects
    are all named.
    """
    if "truth" not in row:
        return robot_page.is_right(row)
    if is_of_several(row):
        return count_found(row) == len(row["truth"]["acting"]) and not has_false_name(row)
    if is_null(row):
        return bool(row["verdict"] == "nothing missing")
    if is_unlisted(row):
        return row["verdict"] != "nothing missing" and not is_law_named(row)
    return is_right_or_alike(row)


def is_false(row: Row) -> bool:
    """Returns whether a law is named that is not there."""
    if "truth" not in row:
        return robot_page.is_wrong(row)
    if is_of_several(row):
        return has_false_name(row)
    if is_null(row) or is_unlisted(row):
        return is_law_named(row)
    return row["verdict"] == "named" and not is_right_or_alike(row)


def study(
    robot: str, effect: str, seed: int, asked: Sequence[str], is_rough: bool = False
) -> dict[str, Any]:
    """Returns what the searches of a world say; an error is a row too.

    Args:
        robot: its kind.
        effect: that it hides.
        seed: of the world.
        asked: passes, and options.
        is_rough: whether the robot also has what no law describes (`robot_worlds`).
    """
    os.environ["INCA_MJ_THREADS"] = "1"
    with TemporaryDirectory() as folder:
        try:
            truth, toml, logs, told = _world(robot, effect, seed, Path(folder), is_rough)
        except UnseenError as error:
            return {"unseen": str(error)}
        passes = [name for name in asked if name in PASSES]
        options = [name for name in asked if name not in PASSES]
        try:
            return {"asked": list(asked), **_answers(truth, toml, logs, told, passes, options)}
        except Exception as error:
            return {"error": f"{type(error).__name__}: {error}"}


Told = Callable[[Any], dict[str, Any]]


def _world(
    robot: str, effect: str, seed: int, folder: Path, is_rough: bool
) -> tuple[dict[str, Any], Path, list[Path], Told]:
    """Returns the truth of a world, its files, and what says in its study's words what is found."""
    if robot not in DRIVEN:
        world = make_world(robot, effect, seed, DURATION)
        toml, *logs = write_world(world, folder)
        return {"truth": truth_of(world)}, toml, logs, hidden_joints.answer_of
    small, motions = make(robot, effect, seed, is_rough)
    toml, logs = write(small, motions, folder)
    truth = {"robot": robot, "effect": small.effect, "joint": small.joint,
             "rough": {joint: round(size, 6) for joint, size in small.rough}}  # fmt: skip
    return truth, toml, logs, robot_models.answer_of


def _answers(
    truth: Row, toml: Path, logs: Sequence[Path], told: Told, passes: Sequence[str],
    options: Sequence[str],
) -> dict[str, Any]:  # fmt: skip
    """Returns the answer of the search as it is, and those of others that differ from it."""
    # These take long to import, and the processes that only write the page need them not.
    from kept_steps import asked, kept_steps

    from identification import InputError, read_robot
    from identification.prediction.discovery import discover_records
    from identification.robot.second_opinion import ask_torques
    from identification.robot.suggestions import suggest

    robot = read_robot(toml, logs[0], confirm=logs[1:])
    torques = ask_torques(robot, None)
    suggested = () if isinstance(torques, InputError) else suggest(torques, robot)
    model, candidates = robot.nominal_model, robot.candidates
    whole: dict[str, Any] = {}
    changed, seconds = {}, {}
    with kept_steps():
        for name, own in variants(passes, options).items():
            begun = time.process_time()
            found = discover_records(
                model, (robot.log,), robot.records, candidates, None, asked(own), suggested
            )
            answer = told(found)
            seconds[name] = time.process_time() - begun
            row = {**truth, **answer}
            short = {"good": is_good(row), "false": is_false(row), "verdict": answer["verdict"],
                     "named": [[n["name"], n["where"]] for n in answer["named"]]}  # fmt: skip
            if name == WHOLE:
                whole = short
            elif short != whole:
                changed[name] = short
    return {"truth": dict(truth), "whole": whole, "changed": changed, "seconds": seconds}


def told(row: Row) -> str:
    """Returns a row in a line."""
    if "whole" not in row:
        return f"{row['key']}: {row.get('unseen') or row['error']}"
    others = ", ".join(f"{n} {row['whole']['good']:d}>{c['good']:d}"
                       for n, c in row["changed"].items())  # fmt: skip
    said = row["whole"]["named"] or row["whole"]["verdict"]
    return f"{row['key']}: {said}, {sum(row['seconds'].values()):.0f} s; {others}"


def section(rows: Sequence[Row]) -> str:
    """Returns the section of the page, Markdown."""
    done = [row for row in rows if "whole" in row]
    head = ["## What passes and options of a search are worth", "",
            "    python benchmarks/ablation.py", ""]  # fmt: skip
    if not done:
        return "\n".join([*head, "Nothing has been left out of the present search.\n"])
    good = sum(row["whole"]["good"] for row in done)
    robots = Counter(row["truth"].get("truth", row["truth"])["robot"] for row in done)
    return "\n".join([
        *head,
        f"Search of {rows[-1]['commit']}, over a horizon. It answers {good} of {len(done)} worlds"
        f" right ({', '.join(f'{robot} {n}' for robot, n in sorted(robots.items()))})."
        " A pass or an option counts by the worlds whose verdict or names change without the pass,"
        " or with the option half and one and a half times as large. *Chance*: that as unequal"
        " numbers come of a pass that is worth nothing (McNemar 1947). *Time*: processor time of a"
        " search without it that is new, over that of the whole search.", "",
        "| without, or with | worlds | other answer | right only with it | right only without it |"
        " chance | laws that are not there, with it and without | time |",
        "|---|---|---|---|---|---|---|---|", *lines(done), "",
    ])  # fmt: skip


def lines(done: Sequence[Row]) -> Iterator[str]:
    """Yields the lines of the table, the pass that changes most first."""
    names = dict.fromkeys(name for row in done for name in row["seconds"] if name)
    for name in sorted(names, key=lambda n: -sum(n in row["changed"] for row in done)):
        mine = [row for row in done if name in row["seconds"]]
        pairs = [(row["whole"], row["changed"].get(name, row["whole"])) for row in mine]
        other = sum(name in row["changed"] for row in mine)
        only_with = sum(a["good"] and not b["good"] for a, b in pairs)
        only_without = sum(b["good"] and not a["good"] for a, b in pairs)
        both = only_with + only_without
        chance = binomtest(only_with, both).pvalue if both else 1.0
        false = [sum(p[k]["false"] for p in pairs) for k in (0, 1)]
        spent = sum(r["seconds"][name] for r in mine) / sum(r["seconds"][WHOLE] for r in mine)
        yield (f"| `{name}` | {len(mine)} | {other} | {only_with} | {only_without} |"
               f" {chance:.2g} | {false[0]}, {false[1]} | {spent:.2f} |")  # fmt: skip


def tasks(given: argparse.Namespace) -> Mapping[str, tuple[Any, ...]]:
    """Returns the worlds by key: every robot and effect once before any twice.

    An arm is in both benches: it is that of `robot_worlds`, whose search is short.
    """
    out: dict[str, tuple[Any, ...]] = {}
    of_robot = {r: [NULL, *effects_of(ROBOTS[r]), THREE] for r in ROBOTS} | {
        r: [*NAMES, *SEVERAL] for r in DRIVEN
    }
    asked = (*given.passes, *given.options)
    for seed in range(given.seed, given.seed + given.count):
        for k in range(max(map(len, of_robot.values()))):
            for robot in given.worlds:
                effects = of_robot[robot]
                if k >= len(effects) or not is_asked(robot, effects[k]):
                    continue
                key = f"{robot}/{effects[k]}/{seed}"
                if not given.rough:
                    out[key] = (robot, effects[k], seed, asked)
                elif robot in DRIVEN:
                    out[f"{key}/rough"] = (robot, effects[k], seed, asked, True)
    return out


def main() -> int:
    """Answer the worlds that are not answered yet, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add, numbers = parser.add_argument, [
        f.name for f in fields(DiscoveryOptions) if f.name not in ("without", "max_minutes")
    ]  # fmt: skip
    add("--worlds", nargs="+", choices=[*DRIVEN, *ROBOTS], default=[*SMALL, *JOINTS],
        metavar="ROBOT")  # fmt: skip
    add("--passes", nargs="*", choices=ASKED, default=ASKED, metavar="PASS")
    add("--options", nargs="*", choices=numbers, default=[], metavar="OPTION")
    add("--rough", action="store_true", help="worlds of robots with what no law describes")
    add("--seed", type=int, default=1)
    add("--count", type=int, default=1, help="worlds of each robot and effect")
    add("--processes", type=int, default=1)
    add("--out", type=Path, default=ROWS)
    add("--page", type=Path, default=PAGE)
    add("--only-page", action="store_true")
    given = parser.parse_args()
    rows = rows_of(given.out) if given.only_page else answered(
        study, tasks(given), given.out, told, given.processes
    )  # fmt: skip
    write_part(given.page, BEGIN, END, section(of_newest(rows) if rows else []))
    return 0


if __name__ == "__main__":
    sys.exit(main())
