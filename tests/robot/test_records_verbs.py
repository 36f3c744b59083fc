"""The words of a user for a discovery over a horizon: text, JSON and confirmation take it."""

from dataclasses import replace

import pytest
from pendulum_robot import TOML, make_folder
from records_cases import records

from identification import (
    confirm,
    discover,
    discovery_text,
    discovery_to_json,
    read_robot,
)

MU = "transmitted_load_friction.mu@hinge"
ONLY = '[effects]\nonly = ["transmitted_load_friction"]\n'


@pytest.fixture
def path(tmp_path):
    make_folder(tmp_path)
    (tmp_path / "robot.toml").write_text(TOML + ONLY)
    return tmp_path / "robot.toml"


@pytest.mark.parametrize("mu", [0.15, 0.0])
def test_text_json_and_confirmation_take_what_records_say(path, mu):
    first, second, third = records(3, {MU: mu} if mu else None, samples=300)
    robot = read_robot(path, [first, second], confirm=[third])
    found = discover(robot)
    assert found.horizon is not None
    verdict = "Missing from the model" if mu else "Nothing is missing"
    assert discovery_text(found).startswith(verdict)
    assert discovery_to_json(found)["verdict"] == ("named" if mu else "nothing missing")
    (compared,) = confirm(robot, found)
    assert compared.log == third.name
    assert confirm(replace(robot, records=()), found) == (compared,)
    assert compared.unit == "rad"
    (error,) = (e for e in found.errors if e.role == "confirm")
    assert compared.after == pytest.approx(error.after, rel=0.01)
    assert compared.after <= (0.5 if mu else 1.0) * compared.before
