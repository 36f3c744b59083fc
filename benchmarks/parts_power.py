"""What it costs in names to keep a part of the unseen data from the search; a line a world.

    python benchmarks/parts_power.py OUT.jsonl [--robot pendulum cart] [--seed 811] [--count 1]

Each world (`joint_worlds`) hides an effect of 0.6 to 2.5 times the sensors' noise, which is little:
of stronger ones every way finds all. It is searched with all unseen data, and with one block of two
or of three kept for the report (`identification.logs.parts`). Worlds that OUT has are not done
again.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import joint_worlds.world as worlds
from joint_worlds.files import write_world
from joint_worlds.motion import ROBOTS

from identification import DiscoveryOptions, read_robot
from identification.logs import parts
from identification.prediction.discovery import discover_records
from identification.sweep.statistics import said, wilson

EFFECTS = (
    "quadratic_friction", "asymmetric_friction", "stribeck_friction", "offset", "cogging", "lag",
    "saturation", "hardening", "coulomb_friction",
)  # fmt: skip
WAYS = {"nothing kept": (3, ("untouched_part",)), "one of two": (2, ()), "one of three": (3, ())}
DURATION = 10.0  # of a record [s]


def searched(robot: str, effect: str, seed: int) -> dict[str, Any]:
    """Returns the answer of each way to one world: "right", "wrong", or the verdict."""
    worlds.RATIOS, worlds.LEAST = (0.6, 2.5), 0.05
    world = worlds.make_world(robot, effect, seed, DURATION)
    answers: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        toml, a, b = write_world(world, Path(folder))
        read = read_robot(toml, a, confirm=[b])
    for way, (parts.REPORT_EVERY, without) in WAYS.items():
        found = discover_records(
            read.nominal_model, [read.log], read.records, read.candidates,
            options=DiscoveryOptions(without=without),
        )  # fmt: skip
        names = {n.name for n in found.named}
        answers[way] = found.verdict
        if names:
            answers[way] = "right" if names & {*world.names} else "wrong"
    return {"robot": robot, "effect": effect, "seed": seed, "ratio": world.ratio, **answers}


def main() -> int:
    """Search what is not done, and print the rates."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--robot", nargs="+", choices=list(ROBOTS), default=["pendulum", "cart"])
    parser.add_argument("--seed", type=int, default=811)
    parser.add_argument("--count", type=int, default=1, help="seeds, each with every effect")
    given = parser.parse_args()
    rows = [json.loads(line) for line in given.out.open()] if given.out.exists() else []
    done = {(r["robot"], r["effect"], r["seed"]) for r in rows}
    for seed in range(given.seed, given.seed + given.count):
        for key in ((robot, effect, seed) for effect in EFFECTS for robot in given.robot):
            if key in done:
                continue
            try:
                rows.append(searched(*key))
            except worlds.UnseenError as error:
                print(*key, error, file=sys.stderr)
                continue
            with given.out.open("a") as file:
                file.write(json.dumps(rows[-1]) + "\n")
            print(rows[-1], file=sys.stderr, flush=True)
    for way in WAYS:
        counts = Counter(row[way] for row in rows)
        rates = ", ".join(f"{kind} {said(wilson(n, len(rows)))}" for kind, n in counts.items())
        print(f"{way}: {rates}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
