"""The folder of a robot: its MJCF, its TOML, and logs of it."""

import pytest
from joint_cases import SLIDER
from robot_cases import HIDDEN, TOML, simulated

from identification import write_log
from identification.robot import robot as made


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


@pytest.fixture
def few_effects(monkeypatch):
    """Robots that are read have two effects: a law of all takes 18 s to compile for new axes."""
    every = made.all_effects
    names = ("coulomb_friction", "quadratic_friction")
    monkeypatch.setattr(
        made, "all_effects", lambda *args: tuple(e for e in every(*args) if e.name.endswith(names))
    )
