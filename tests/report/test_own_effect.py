"""The example of a user's own effect: it acts, it can be kept, and it is found."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from effect_cases import BY_NAME
from fake_discovery import found, log, truth

from identification.errors import InputError
from inca_mj import build_twin, make_input, simulate
from inca_mj.twin.saved import load_twin, save_twin
from inca_mj.workflows.discovery_model import named_twin, rerun

EXAMPLE = Path(__file__).parents[2] / "examples" / "own_effect.py"


@pytest.fixture(scope="module")
def own():
    return runpy.run_path(str(EXAMPLE))


def test_it_acts_and_is_nothing_at_zero(own):
    u = make_input("prbs", 0.5)
    robot = own["robot_with_it"]()
    nominal = simulate(build_twin(), u).motor_angle
    without = simulate(robot.with_values({"winding_friction.c": 0.0}), u).motor_angle
    np.testing.assert_array_equal(without, nominal)
    assert np.abs(simulate(robot, u).motor_angle - nominal).max() > 0.01


def test_it_is_kept_and_asked_for_by_name(own, tmp_path):
    save_twin(own["robot_with_it"](), tmp_path)
    with pytest.raises(InputError, match="winding_friction; pass them"):
        load_twin(tmp_path)
    again = load_twin(tmp_path, effects=[own["WINDING_FRICTION"]])
    assert again.parameters["winding_friction.c"].value == 5e-4


@pytest.mark.long
def test_it_is_found(own):
    found = own["find"](
        own["log_with_it"](4.0), effects=(BY_NAME["stribeck_friction"], own["WINDING_FRICTION"])
    )
    assert [n.candidate.effect.name for n in found.named] == ["winding_friction"]
    value, std, _ = found.named[0].parameters["c"]
    assert abs(value - 5e-4) < 5 * std


def test_one_of_a_joint_is_found_beside_those_of_the_catalogue(own, monkeypatch):
    find, beside = own["find_on_slider"], ("guide_friction", "coulomb_friction", "hardening")
    every = find.__globals__["candidates"]
    few = lambda *given: [e for e in every(*given) if e.name in beside]  # noqa: E731
    monkeypatch.setitem(find.__globals__, "candidates", few)
    found = find(own["slider_log"]())
    assert [n.candidate.effect.name for n in found.named] == ["guide_friction"]
    value, std, unit = found.named[0].parameters["c"]
    assert abs(value - 1.0) < 5 * std
    assert unit == "N/m"


@pytest.fixture
def saved(tmp_path):
    save_twin(named_twin(found()), tmp_path)
    return tmp_path


def test_the_trajectory_comes_back_bit_for_bit(saved):
    robot, again = named_twin(found()), load_twin(saved)
    assert again.parameters.values() == robot.parameters.values()
    assert again.effects == (BY_NAME["stribeck_friction"],)
    a, b = rerun(robot, log()), rerun(again, log())
    for name in ("qpos", "qvel", "act", "tension"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


def test_every_place_and_input_effect_comes_back(tmp_path):
    robot = truth().with_values({"friction_mismatch.delta@3": 0.1 / 3, "delay.tau": 0.001 / 7})
    save_twin(robot, tmp_path)
    again = load_twin(tmp_path)
    assert again.parameters.values() == robot.parameters.values()
    np.testing.assert_array_equal(rerun(robot, log()).qpos, rerun(again, log()).qpos)


def test_the_named_twin_is_the_final_fit():
    robot = named_twin(found())
    np.testing.assert_allclose(
        rerun(robot, log()).motor_angle, log().outputs - found().run.after, rtol=0, atol=1e-9
    )


@pytest.mark.parametrize(
    ("change", "names"),
    [
        (lambda t: t.replace("exp(-|ω", "exp(-|2 ω"), "another law"),
        (lambda t: t[:40], "cannot be read as JSON"),
    ],
)
def test_damaged_files(saved, change, names):
    path = saved / "effects.json"
    path.write_text(change(path.read_text()))
    with pytest.raises(InputError, match=names):
        load_twin(saved)
