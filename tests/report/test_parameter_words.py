"""Readers meet parameters in words, with the letter of the equations; JSON keeps the names."""

import fake_discovery
import pytest

from identification.model.parameter import Parameter, ParameterSet, with_own
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_tables import parameters_section
from identification.report.parameter_words import (
    describe_parameter,
    parameter_words,
    with_letter,
    words_of,
)
from inca_mj.report.sections import model_section
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread

EVERY = with_spread(parameter_set())


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("lambda", "cable elasticity λ"),
        ("lambda@5", "cable elasticity λ, drive 5"),
        ("K_t@3", "torque constant K_t, drive 3"),
        ("I_x", "platform inertia I_x"),
        ("exit_x@2", "exit point A, cable 2, along x"),
    ],
)
def test_a_parameter_is_said_in_words_with_its_letter_and_its_place(name, said):
    assert describe_parameter(EVERY[name]) == said


def test_words_tell_all_parameters_of_the_robot_apart_and_none_is_a_raw_name():
    words = parameter_words(EVERY)
    assert len({*words.values()}) == len(words) > 100
    assert not [w for w in words.values() if "@" in w or w in words]


def test_values_of_single_records_are_told_apart():
    own = with_own(EVERY, ("x", "yaw"), 3)
    words = parameter_words(own)
    assert words["x [2]"] == "start position x, record 2"
    assert words["yaw [3]"] == "start yaw ψ_p, record 3"
    assert len({*words.values()}) == len(words)


def test_a_parameter_without_words_keeps_its_name():
    mine = Parameter(name="joint/elbow.damping", value=1.0, unit="", where="joint/elbow.damping")
    assert describe_parameter(mine) == "joint/elbow.damping"
    records = with_own(ParameterSet("mine", (mine,)), (mine.name,), 2)
    assert [*parameter_words(records).values()] == [mine.name, f"{mine.name} [2]"]


def test_a_letter_that_the_words_have_is_not_said_twice():
    assert with_letter("mass m of the cart", "m") == "mass m of the cart"
    assert with_letter("mass of the cart", "m") == "mass of the cart m"


def test_tables_have_the_words_and_json_has_the_names():
    found = fake_discovery.found()
    words = words_of(found)
    first = [row[0] for row in parameters_section(found).table.rows]
    assert first[0] == "viscous friction b_v"
    assert "f_s, friction – Stribeck peak, all drives" in first
    assert "v_s, friction – Stribeck peak" in first
    assert {*first} <= {*words.values()}
    assert discovery_to_json(found)["effects"][0]["retuned"]["parameter"] == "m"


def test_the_table_of_the_model_has_the_words_of_its_effects():
    robot = fake_discovery.truth()
    first = [row[0] for row in model_section(robot).table.rows]
    assert first == [*parameter_words(robot.parameters, robot.effects).values()]
    assert "delta, friction – Coulomb part differs at one drive, drive 3" in first
