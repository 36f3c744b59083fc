"""Small robots in the manner of MuJoCo Menagerie: how often what their model lacks is named.

    python benchmarks/robot_models.py [--robots leg crane] [--effects stop two] [--count 2]
                                      [--seed 1] [--rough | --exact] [--processes 2]
    python benchmarks/robot_models.py --only-page             the page anew, from the rows

Each world (`robot_worlds`) is simulated with one effect that its model lacks. The first of two
records is searched with all candidates, the second confirms. A finished world is a line of ROWS,
and is not made again by the same search. The page docs/robot/models.md is of one search. Seconds
are those of the processor.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from robot_motions import DRIVEN
from robot_page import WORDS, page, told
from robot_worlds import NAMES, SEVERAL, is_asked, make, write
from rows import ROOT, answered, of_newest, rows_of

from identification.discovery.result import Discovery

ROWS = ROOT / "benchmarks" / "results" / "robot_models.jsonl"
PAGE = ROOT / "docs" / "robot" / "models.md"


def study(
    robot: str,
    effect: str,
    seed: int,
    without: tuple[str, ...],
    is_rough: bool = False,
    has_clocks: bool = False,
) -> dict[str, Any]:
    """Returns what a search says of a world; an error is a row too."""
    from identification import DiscoveryOptions, discover, read_robot

    world, motions = make(robot, effect, seed, is_rough, has_clocks)
    row: dict[str, Any] = {
        "robot": robot, "effect": world.effect, "joint": world.joint,
        "size": "+".join(f"{h.size:.4g}" for h in world.hidden), "seed": seed,
        "rough": {joint: round(size, 6) for joint, size in world.rough},
        "clocks": list(world.clocks),
    }  # fmt: skip
    begun = time.process_time()
    try:
        with TemporaryDirectory() as folder:
            toml, logs = write(world, motions, Path(folder))
            options = DiscoveryOptions(without=without)
            found = discover(read_robot(toml, logs[0], confirm=[logs[1]]), options=options)
    except Exception as error:
        return {**row, "error": f"{type(error).__name__}: {error}"}
    return {**row, **answer_of(found), "seconds": time.process_time() - begun}


def answer_of(found: Discovery) -> dict[str, Any]:
    """Returns what a search says, as a row has it."""
    return {
        "verdict": found.verdict, "times_noise": found.times_noise(found.after),
        "share": found.share, "smooth_share": found.smooth_share,
        "differences": [
            [d.name, d.where, {n: v for n, (v, _) in d.values.items()}] for d in found.differences
        ],
        "moves": list(found.moves), "cut_short": list(found.cut_short),
        "named": [
            {"name": n.name, "where": n.where, "confidence": n.confidence,
             "rivals": [[r.name, r.where, r.confidence] for r in n.rivals],
             "smooth_share": n.smooth_share,
             "sizes": {name: p[0] for name, p in n.parameters.items()},
             "std": {name: p[1] for name, p in n.parameters.items()},  # 0 where it is held
             "untouched_t": n.proof.untouched.t if n.proof.untouched else None}
            for n in found.named
        ],
        "rejected": [[r.candidate.effect.name, r.candidate.where, r.doubt] for r in found.rejected],
    }  # fmt: skip


def main() -> None:
    """Make the rows that this search has not made yet, and the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    add = parser.add_argument
    add("--robots", nargs="*", choices=[*WORDS], default=[*DRIVEN])
    add("--effects", nargs="*", choices=[*NAMES, *SEVERAL], default=[*NAMES, *SEVERAL])
    add("--seed", type=int, default=1)
    add("--count", type=int, default=1, help="worlds of each robot and effect")
    add("--clocks", action="store_true", help="records that two clocks stamped; give --out too")
    add("--without", nargs="*", default=[], help="passes that are left out; give --out too")
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--rough", action="store_true", help="rough worlds only")
    only.add_argument("--exact", action="store_true", help="worlds that are not rough only")
    add("--processes", type=int, default=1)
    add("--out", type=Path, default=ROWS)
    add("--page", type=Path, default=PAGE)
    add("--only-page", action="store_true")
    given = parser.parse_args()
    tasks = {
        f"{robot}/{effect}/{seed}" + "/rough" * rough + "/clocks" * given.clocks:
            (robot, effect, seed, tuple(given.without), rough, given.clocks)
        for rough in ((True,) if given.rough else (False,) if given.exact else (False, True))
        for seed in range(given.seed, given.seed + given.count)
        for effect in given.effects
        for robot in given.robots
        if is_asked(robot, effect)
    }  # fmt: skip
    rows = rows_of(given.out) if given.only_page else answered(
        study, tasks, given.out, lambda r: f"{r['key']}: {told(r)}", given.processes
    )  # fmt: skip
    given.page.write_text(page(of_newest(rows)), encoding="utf-8")


if __name__ == "__main__":
    main()
