"""Drives that differ and points that are displaced: one robot, whichever way it is described."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from twin_cases import UNREAD, differing

from identification import InputError
from identification.model.predictor import Predictor
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import (
    EACH_DRIVE,
    at_drives,
    deviations,
    displaced,
    displacements,
    with_spread,
)
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.saved import load_twin, save_twin
from inca_mj.twin.twin import build_twin


@cache
def spread():
    return build_twin(with_spread(parameter_set()))


DEVIATIONS = [p.name for p in deviations()]
DISPLACEMENTS = [p.name for p in displacements()]


def drawn(seed):
    """A robot of which no drive is like another and no point is where it is drawn."""
    rng = np.random.default_rng(seed)
    own = dict(zip(DEVIATIONS, rng.uniform(-0.1, 0.1, len(DEVIATIONS)), strict=True))
    moved = dict(zip(DISPLACEMENTS, rng.uniform(-3e-3, 3e-3, len(DISPLACEMENTS)), strict=True))
    return own | moved


def test_without_deviations_the_model_is_the_nominal_one_to_the_bit():
    assert differing(spread().model, build_twin().model) == set()


@settings(deadline=None, max_examples=5)
@given(st.integers(0, 2**32 - 1))
def test_new_deviations_equal_a_new_compilation(seed):
    values = drawn(seed) | {"lambda": 26e3, "x": 0.02}
    written = spread().with_values(values)
    compiled = build_twin(with_spread(parameter_set()).with_values(values))
    assert differing(written.model, compiled.model) <= UNREAD
    currents = prbs(21, 0.01)
    ours, theirs = simulate(written, currents), simulate(compiled, currents)
    np.testing.assert_array_equal(ours.qpos, theirs.qpos)
    np.testing.assert_array_equal(ours.tension, theirs.tension)


def test_a_batch_of_robots_equals_each_robot_by_itself():
    currents = prbs(31, 0.01)
    log = run_to_log(simulate(build_twin(), currents))
    sets = [drawn(seed) for seed in (1, 2, 3)]
    names = tuple(sets[0])
    batch = Predictor(spread(), log, names).predict(np.array([[*s.values()] for s in sets]))
    for predicted, values in zip(batch, sets, strict=True):
        alone = simulate(spread().with_values(values), currents)
        np.testing.assert_allclose(predicted, alone.motor_angle, atol=1e-12)


def test_equal_deviations_of_all_drives_are_another_common_value():
    currents = prbs(31, 0.01)
    for name in EACH_DRIVE:
        common = parameter_set()[name].value
        ours = spread().with_values({f"{name}@{k}": 0.05 for k in range(1, 9)})
        theirs = build_twin(parameter_set("trial", {name: 1.05 * common}))
        a, b = (simulate(robot, currents).motor_angle for robot in (ours, theirs))
        np.testing.assert_allclose(a, b, atol=1e-11)


def test_displaced_points_are_another_geometry():
    values = {name: value for name, value in drawn(4).items() if name in DISPLACEMENTS}
    moved = displaced(INCA, values)
    np.testing.assert_allclose(moved.A[2, 1] - INCA.A[2, 1], values["exit_y@3"])
    currents = prbs(31, 0.01)
    ours = simulate(spread().with_values(values), currents)
    theirs = simulate(build_twin(geometry=moved), currents)
    np.testing.assert_allclose(ours.motor_angle, theirs.motor_angle, atol=1e-12)


def test_a_displacement_that_is_added_to_all_points_moves_the_robot_as_a_whole():
    """Frame and start moved together: the drives cannot tell."""
    shift = {f"exit_{a}@{k}": d for k in range(1, 9) for a, d in zip("xyz", (0.02, -0.01, 0.015),
                                                                       strict=True)}  # fmt: skip
    start = parameter_set().values()
    here = {n: start[n] + d for n, d in zip("xyz", (0.02, -0.01, 0.015), strict=True)}
    currents = prbs(31, 0.01)
    a = simulate(spread().with_values(shift | here), currents).motor_angle
    b = simulate(spread(), currents).motor_angle
    np.testing.assert_allclose(a, b, atol=1e-10)


def test_it_rests_when_no_current_flows():
    run = simulate(spread().with_values(drawn(5)), np.zeros((51, 8)))
    assert np.abs(run.motor_angle).max() < 1e-9


def test_a_saved_robot_is_the_same_to_the_bit(tmp_path):
    robot = spread().with_values(drawn(6))
    save_twin(robot, tmp_path)
    again = load_twin(tmp_path)
    assert again.parameters.values() == robot.parameters.values()
    assert differing(again.model, robot.model) <= UNREAD


def test_values_at_drives_follow_the_definition():
    values = parameter_set().values() | {"R@2": 0.1, "R@8": -0.2}
    expected = values["R"] * np.array([1, 1.1, 1, 1, 1, 1, 1, 0.8])
    np.testing.assert_allclose(at_drives("R", values), expected, rtol=1e-15)
    assert displaced(INCA, values) is INCA


def test_an_unknown_deviation_is_refused(refusal):
    assert "K_t@9" in refusal(spread().with_values, {"K_t@9": 0.1})
    with pytest.raises(InputError):
        build_twin().with_values({"K_t@1": 0.1})
    once = with_spread(parameter_set())
    assert with_spread(once) == replace(once)
