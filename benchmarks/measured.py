"""What is missing in robots that were measured: fit, discover, confirm; one JSON a robot, one page.

    python benchmarks/measured.py [ROBOT…] [--data ../shared/data] [--page docs/measured.md]
    python benchmarks/measured.py silverbox --split 2     does another split contradict the name?
    python benchmarks/measured.py emps --null 20          how many nulls of the robot get a name?
    python benchmarks/measured.py ur10e --null 20 --few 1 the same with one record of each kind
    python benchmarks/measured.py --write FOLDER          records as CSV, models and TOML
    python benchmarks/measured.py --again                 all but fits and discoveries anew
    python benchmarks/measured.py --take FOLDER           records of the sweep sweeps/measured.toml
    python benchmarks/measured.py --only-page             the page anew, from the JSON records

A robot whose data are absent is skipped, with a sentence. What the page tells is in the JSON
records of `--records`, and nothing else is.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any

from robots import ROBOTS, reader
from robots.measured_robot import MeasuredRobot
from robots.page import page

HERE = Path(__file__).parent
DATA = HERE.parents[1] / "shared" / "data"
RECORDS = HERE / "results" / "measured"
PAGE = HERE.parent / "docs" / "measured.md"


def main() -> int:
    """Measure, write the records, write the page."""
    given = parsed()
    unknown = [name for name in given.robots if name not in ROBOTS]
    if unknown:
        print(f"unknown robot {unknown[0]!r}; known: {', '.join(ROBOTS)}", file=sys.stderr)
        return 2
    if given.take is not None:
        take(given)
    elif not given.only_page:
        for name in given.robots or ROBOTS:
            try:
                robot = reader(name)(given.data)
            except FileNotFoundError as error:
                print(f"{name} is skipped: {error}; benchmarks/robots/{name}.py says whose data"
                      " these are", flush=True)  # fmt: skip
                continue
            work(robot, given)
    if given.write is None:
        given.page.write_text(page(given.records), encoding="utf-8")
        print(f"{given.page} is written from {given.records}")
    return 0


def work(robot: MeasuredRobot, given: argparse.Namespace) -> None:
    """What is asked of one robot."""
    if given.write is not None:
        from robots.written import command, write_files

        path, paths = write_files(robot, given.write / robot.name)
        print(command(path, paths))
        return
    split = robot.split(given.split)
    ending = "" if given.split == 1 else f"_split_{given.split}"
    if given.null:
        from robots.nulls import null_study

        few = split.few(given.few) if given.few else split
        for record in null_study(few, given.null, say):
            keep(given, f"{robot.name}{ending}_null", record)
        return
    from robots.measurement import measure, measure_again

    if given.again:
        for path in sorted(given.records.glob(f"{robot.name}.json")):
            kept = json.loads(path.read_text(encoding="utf-8"))
            keep(given, path.stem, measure_again(robot, kept))
        return
    keep(given, robot.name + ending, measure(split, say))
    if given.split == 1:
        for what, values in robot.starts.items():
            slug = re.sub(r"\W+", "_", what)
            again = measure(split.started(values), say)
            keep(given, f"{robot.name}_start_{slug}", again, start=what)
        for what, names in robot.lacking.items():
            slug = re.sub(r"\W+", "_", what)
            poorer = measure(split.poorer(names), say)
            keep(given, f"{robot.name}_start_{slug}", poorer, start=what)


def take(given: argparse.Namespace) -> None:
    """Keep the JSON records of a sweep, as those of a run of this program."""
    from datetime import UTC, datetime

    from pyarrow.dataset import dataset

    for row in dataset(given.take / "records").to_table().to_pylist():
        if row["error"] is None:
            ending = "" if row["set.split"] == 1 else f"_split_{row['set.split']}"
            day = datetime.fromtimestamp(row["run.ended"], UTC).date().isoformat()
            version, _, commit = row["run.code"].partition(", ")
            own = {"date": day, "version": version, "commit": commit, "seconds": row["run.seconds"]}
            keep(given, row["set.robot"] + ending, {**json.loads(row["record"]), **own})


def keep(given: argparse.Namespace, name: str, record: dict[str, Any], **more: str) -> None:
    """Write a JSON record."""
    record = {**record, **more}
    given.records.mkdir(parents=True, exist_ok=True)
    path = given.records / f"{name}.json"
    path.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"{path} is written", flush=True)


def say(line: str) -> None:
    """Progress."""
    print(line, file=sys.stderr, flush=True)


def parsed() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help=", ".join(ROBOTS))
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--records", type=Path, default=RECORDS)
    parser.add_argument("--page", type=Path, default=PAGE)
    parser.add_argument("--split", type=int, choices=(1, 2), default=1)
    parser.add_argument("--null", type=int, default=0, metavar="N")
    parser.add_argument("--few", type=int, default=0, metavar="N", help="records of each kind")
    parser.add_argument("--write", type=Path, metavar="FOLDER")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--only-page", action="store_true")
    parser.add_argument("--take", type=Path, metavar="FOLDER", help="of a sweep")
    return parser.parse_args()


if __name__ == "__main__":
    raise SystemExit(main())
