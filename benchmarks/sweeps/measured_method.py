"""A robot that others measured as a task of a sweep: what `benchmarks/measured.py` does of one."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from identification.errors import InputError, unknown_name
from identification.sweep.method import Column, Method, Seed

sys.path.append(str(Path(__file__).parents[1]))
from robots import ROBOTS, reader

TIMES = ("date", "commit", "version", "seconds")  # of a record: no two runs have them in common


@dataclass(frozen=True, kw_only=True)
class Measured:
    """Which robot."""

    robot: str  # a name of `benchmarks/robots`
    data: Path  # folder of the data of all robots
    split: int = 1  # 1 or 2, which records are fitted

    def __post_init__(self) -> None:
        if self.robot not in ROBOTS:
            raise unknown_name("robot", self.robot, ROBOTS)


def measured(settings: Measured, seed: Seed) -> dict[str, Any]:
    """Fit, discover and confirm; nothing is left to chance, so the seed is not used."""
    from robots.measurement import measure

    try:
        robot = reader(settings.robot)(settings.data).split(settings.split)
    except FileNotFoundError as error:
        raise InputError(f"{error}; benchmarks/robots/{settings.robot}.py says whose") from error
    record = {k: v for k, v in measure(robot, lambda line: None).items() if k not in TIMES}
    found = record.get("discovery", {})
    found.pop("seconds", None)
    gap = found.get("gap", {})
    return {
        "verdict": found.get("verdict", "refused"),
        "named": [effect["name"] for effect in found.get("effects", [])],
        "where": [effect["where"] for effect in found.get("effects", [])],
        "before": gap.get("before", {}).get("rms"), "after": gap.get("after", {}).get("rms"),
        "record": json.dumps(record, ensure_ascii=False),
    }  # fmt: skip


MEASURED = Method(
    about="fits, discovers and confirms on the records of a robot that others measured",
    settings=Measured,
    columns={
        "verdict": Column(str, "the outcome in a word"),
        "named": Column(list[str], "effects that are named"),
        "where": Column(list[str], "their places"),
        "before": Column(float, "rms over the horizon on unseen records [unit of the outputs]"),
        "after": Column(float, "the same with what is named"),
        "record": Column(str, "all that docs/measured.md tells of the robot, as JSON"),
    },
    run=measured,
)
