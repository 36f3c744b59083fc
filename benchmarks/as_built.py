"""Robots as they are built: every drive different, geometry off. What a calibration and a
discovery find, against the truth; rows and a page.

    python benchmarks/as_built.py calibrate --data FOLDER [--robot robot_00 ...] [--records abc]
    python benchmarks/as_built.py discover --data FOLDER [--records a] [--spread usual|none]
    python benchmarks/as_built.py time --data FOLDER [--robot robot_00 ...] [--records abc]
    python benchmarks/as_built.py --take FOLDER    of inca sweep benchmarks/sweeps/as_built.toml
    python benchmarks/as_built.py --only-page

FOLDER holds logs `robot_NN_a.csv`, `_b`, `_c` of one robot each, and labels.json with the truth. A
row that is done is not done again. `time` is a discovery on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from as_built_statistics import page

from identification.sweep.work import commit

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "as_built"
PAGE = HERE.parent / "docs" / "as_built.md"
LABELS = {
    "R": "R", "R_s": "Rs", "k_s": "ks", "lambda": "lam", "b": "b", "J": "J", "b_v": "bv",
    "b_c": "bc", "K_t": "Kt",
}  # fmt: skip


def calibrated(logs: list[Any], confirm: list[Any], truth: dict[str, Any]) -> dict[str, Any]:
    """A calibration against the truth: errors and what was told of them."""
    from inca_mj import calibrate
    from inca_mj.robot.spread import at_drives

    found = calibrate(logs, confirm=confirm, progress=note)
    values, names = found.robot.parameters.values(), list(found.fit.point.space.names)
    drives = {}
    for name, label in LABELS.items():
        true = np.array(truth["parameters"][label], float)
        error = at_drives(name, values) / true - 1
        told = [_std(found.covariance, names, [name, f"{name}@{k}"]) for k in range(1, 9)]
        drives[name] = {"error": error.tolist(), "std": told}
    geometry = found.robot.geometry
    std = found.std
    points = {
        point: {
            "error": (now - np.array(truth[label])).tolist(),
            "std": [[std[f"{point}_{axis}@{k}"] for axis in "xyz"] for k in range(1, 9)],
            "before": (drawn - np.array(truth[label])).tolist(),
        }
        for point, label, now, drawn in (
            ("exit", "anchors", geometry.A, found.fit.point.predictor.plant.geometry.A),
            ("connector", "connectors", geometry.B, found.fit.point.predictor.plant.geometry.B),
        )
    }
    inertia = {
        name: {"error": values[name] / true - 1, "std": std[name] / values[name]}
        for name, true in zip(("I_x", "I_y", "I_z"), truth["inertia"], strict=True)
    }
    mass = {"error": values["m"] / truth["parameters"]["m"] - 1, "std": std["m"] / values["m"]}
    return {
        "drives": drives, "points": points, "platform": {**inertia, "m": mass},
        "scatter": dict(found.scatter), "unseen": [vars(gap) for gap in found.unseen],
    }  # fmt: skip


def _std(covariance: np.ndarray, names: list[str], sum_of: list[str]) -> float:
    """Std of a sum of coordinates, such as a common value and the deviation of a drive."""
    direction = np.isin(names, sum_of).astype(float)
    return float(np.sqrt(direction @ covariance @ direction))


def discovered(logs: list[Any], confirm: list[Any], spread: str) -> dict[str, Any]:
    """The answer of a discovery."""
    from inca_mj import discover
    from inca_mj.workflows.spread import spread_of

    found = discover(logs, confirm=confirm, spread=spread_of(spread), progress=note)
    return {
        "verdict": found.verdict, "unexplained": found.unexplained,
        "named": [
            {"name": n.candidate.effect.name, "where": n.candidate.where,
             "confidence": n.confidence, "one_of": n.one_of,
             "rivals": [r.candidate.effect.name for r in n.rivals],
             "sizes": {name: p[0] for name, p in n.parameters.items()}}
            for n in found.named
        ],
        "scores": [[s.candidate.effect.name, s.candidate.where, s.gain] for s in found.scores[:5]],
        "before": found.before.rms, "after": found.after.rms, "noise": found.noise_rms,
        "stages": dict(found.seconds),
    }  # fmt: skip


def note(line: str) -> None:
    """A line of progress."""
    print(line, file=sys.stderr, flush=True)


def study(
    verb: str, robot: str, given: argparse.Namespace, label: dict[str, Any]
) -> dict[str, Any]:
    """One row; an error is one too."""
    from inca_mj import read_inca_log

    logs, confirm = (
        [read_inca_log(given.data / f"{robot}_{x}.csv") for x in letters]
        for letters in (given.records, given.confirm)
    )
    begun, processor = time.perf_counter(), time.process_time()
    try:
        if verb == "calibrate":
            answer = calibrated(logs, confirm, label)
        else:
            answer = discovered(logs, confirm, given.spread)
    except Exception as error:
        answer = {"error": f"{type(error).__name__}: {error}"}
    kept = {key: label[key] for key in ("kind", "effects", "where", "size")}
    return {
        "key": key_of(robot, given), "robot": robot, "truth": kept, **answer,
        "commit": commit(), "seconds": time.perf_counter() - begun,
        "processor_seconds": time.process_time() - processor,
    }  # fmt: skip


def key_of(robot: str, given: argparse.Namespace) -> str:
    """What tells a row from others."""
    return f"{robot}/{given.records}/{given.confirm}/{given.spread}"


def rows_of(path: Path) -> list[dict[str, Any]]:
    """Rows of earlier runs, the last of each key."""
    if not path.exists():
        return []
    rows = [json.loads(line) for line in path.read_text().splitlines() if line.endswith("}")]
    return list({row["key"]: row for row in rows}.values())


def worlds_of(folder: Path) -> list[dict[str, Any]]:
    """Rows of the page from the records of a sweep over worlds."""
    from pyarrow.dataset import dataset

    from identification.sweep.answers import nested

    rows = []
    for record in dataset(folder / "records").to_table().sort_by("task").to_pylist():
        if record["error"] is None:
            key = f"world/{record['world']}/{record['kind']}/{record['ratio']:g}"
            key += "/beside the spread" * record["set.as_built"]
            key += f"/{record['set.duration']:g} s/{record['set.records']} records"
            rows.append({"key": key, **nested(record), "code": record["run.code"]})
    return rows


def take(folder: Path, path: Path) -> None:
    """Add those rows to a file that does not have them."""
    there = {row["key"] for row in rows_of(path)}
    with path.open("a", encoding="utf-8") as file:
        for row in worlds_of(folder):
            if row["key"] not in there:
                file.write(json.dumps(row) + "\n")


def main() -> int:
    """Run what is not done, write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("verb", nargs="?", choices=("calibrate", "discover", "time"))
    add("--data", type=Path, default=Path(os.environ.get("AS_BUILT", "practice_robots")))
    add("--robot", nargs="+", default=[])
    add("--records", default="a", help="letters of the records that are fitted")
    add("--confirm", default="", help="letters of the records that confirm")
    add("--spread", default="usual")
    add("--out", type=Path, default=RESULTS)
    add("--page", type=Path, default=PAGE)
    add("--only-page", action="store_true")
    add("--take", type=Path, help="folder of a sweep over worlds, for the page")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if given.take is not None:
        take(given.take, given.out / "worlds.jsonl")
    if given.verb and not given.only_page:
        labels = json.loads((given.data / "labels.json").read_text())
        path = given.out / f"{given.verb}.jsonl"
        done = {row["key"] for row in rows_of(path) if "error" not in row}
        for robot in given.robot or sorted(labels):
            if key_of(robot, given) not in done:
                row = study(given.verb, robot, given, labels[robot])
                with path.open("a") as file:
                    file.write(json.dumps(row) + "\n")
                note(f"{row['key']}: {row.get('verdict') or row.get('error') or 'calibrated'}")
    rows = [
        rows_of(given.out / f"{verb}.jsonl") for verb in ("calibrate", "discover", "worlds", "time")
    ]
    given.page.write_text(page(*rows), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
