"""The folder of a robot: its MJCF, its TOML, and logs of it."""

import pytest
from joint_cases import SLIDER
from robot_cases import HIDDEN, TOML, simulated

from identification import write_log


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("robot")
    (path / "slider.xml").write_text(SLIDER)
    (path / "robot.toml").write_text(TOML)
    plain = {"damping": 3.6, "mass": 1.8}
    write_log(simulated(plain), path / "plain.csv")
    write_log(simulated(plain, seed=5, start=0.2), path / "other.csv")
    write_log(simulated({**plain, **HIDDEN}, samples=700), path / "hidden.csv")
    return path
