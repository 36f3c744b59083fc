"""The elbow of the examples, and what a search among two effects finds of it in some seconds."""

from functools import cache
from pathlib import Path

import pytest

from identification import discover, fit, read_robot
from identification.robot import discovery as of_robots

ELBOW = Path(__file__).parents[2] / "examples" / "elbow"
FEW = ("coulomb_friction", "quadratic_friction")


@cache
def elbow():
    """The robot, and what a search among a few effects finds."""
    robot = read_robot(
        ELBOW / "elbow.toml", ELBOW / "first.csv", confirm=[ELBOW / "second.csv"]
    )  # fmt: skip
    search = of_robots.discover_records

    def short(model, fitted, records, effects, *rest):
        return search(model, fitted, records, [e for e in effects if e.name in FEW], *rest)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(of_robots, "discover_records", short)
        return robot, discover(robot)


@cache
def fitted():
    return fit(elbow()[0])
