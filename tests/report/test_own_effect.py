"""The example of a user's own effect: it acts, it can be kept, and it is found."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from identification.errors import InputError
from inca_mj import build_twin, make_input, simulate
from inca_mj.effects.motor import STRIBECK_FRICTION
from inca_mj.twin.saved import load_twin, save_twin

EXAMPLE = Path(__file__).parents[2] / "examples" / "own_effect.py"


@pytest.fixture(scope="module")
def own() -> dict:
    return runpy.run_path(str(EXAMPLE))


def test_it_acts_and_is_nothing_at_zero(own: dict) -> None:
    u = make_input("prbs", 0.5)
    robot = own["robot_with_it"]()
    nominal = simulate(build_twin(), u).motor_angle
    without = simulate(robot.with_values({"winding_friction.c": 0.0}), u).motor_angle
    np.testing.assert_array_equal(without, nominal)
    assert np.abs(simulate(robot, u).motor_angle - nominal).max() > 0.01


def test_it_is_kept_and_asked_for_by_name(own: dict, tmp_path: Path) -> None:
    save_twin(own["robot_with_it"](), tmp_path)
    with pytest.raises(InputError, match="winding_friction; pass them"):
        load_twin(tmp_path)
    again = load_twin(tmp_path, effects=[own["WINDING_FRICTION"]])
    assert again.parameters["winding_friction.c"].value == 5e-4


@pytest.mark.long
def test_it_is_found(own: dict) -> None:
    found = own["find"](
        own["log_with_it"](4.0), effects=(STRIBECK_FRICTION, own["WINDING_FRICTION"])
    )
    assert [n.candidate.effect.name for n in found.named] == ["winding_friction"]
    value, std, _ = found.named[0].parameters["c"]
    assert abs(value - 5e-4) < 5 * std


def test_one_of_a_joint_is_found_beside_the_catalogue(own: dict) -> None:
    found = own["find_on_slider"](own["slider_log"]())
    assert [n.candidate.effect.name for n in found.named] == ["guide_friction"]
    value, std, unit = found.named[0].parameters["c"]
    assert abs(value - 1.0) < 5 * std
    assert unit == "N/m"
