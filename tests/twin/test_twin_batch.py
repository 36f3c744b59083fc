"""One compiled model serves every value: written, expanded or compiled, the bits are the same."""

from functools import cache

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mujoco.batch import Batch
from twin_cases import UNREAD, differing, laws, moving

from identification.model.predictor import Predictor
from identification.model.rollout import rollout
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import prbs
from inca_mj.robot.parameters import SETS, parameter_set
from inca_mj.robot.spread import EACH_DRIVE, deviations, displaced, displacements, with_spread
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin


@cache
def nominal():
    return build_twin()


START = {"x": 0.03, "y": -0.02, "z": 1.45, "roll": 0.05, "pitch": 0.02, "yaw": -0.1}


@settings(deadline=None, max_examples=10)
@given(laws)
def test_new_values_equal_a_new_compilation(values):
    _refuse_difference(nominal(), parameter_set(), values | START)


@settings(deadline=None, max_examples=5)
@given(st.integers(0, 2**32 - 1))
def test_so_do_new_deviations_of_drives_and_points(seed):
    values = drawn(seed) | {"lambda": 26e3, "x": 0.02}
    _refuse_difference(spread(), with_spread(parameter_set()), values)


def _refuse_difference(robot, parameters, values):
    written, compiled = robot.with_values(values), build_twin(parameters.with_values(values))
    assert differing(written.model, compiled.model) <= UNREAD
    currents = prbs(21, 0.01)
    ours, theirs = simulate(written, currents), simulate(compiled, currents)
    np.testing.assert_array_equal(ours.qpos, theirs.qpos)
    np.testing.assert_array_equal(ours.tension, theirs.tension)


def test_new_values_leave_the_old_twin_alone():
    before = build_twin()
    nominal().with_values({"lambda": 1e5, "m": 0.3, "z": 1.5})
    assert differing(before.model, nominal().model) == set()


def test_what_is_only_drawn_moves_no_bit():
    start, currents = moving(2), prbs(11, 0.01)
    bare = build_twin(visual=False)
    assert bare.model.ngeom == 0 < nominal().model.ngeom
    drawn, plain = (
        rollout(robot.model, start, currents, 0.01, record=("qpos", "qvel", "act"))
        for robot in (nominal(), bare)
    )
    for field, values in drawn.items():
        np.testing.assert_array_equal(values, plain[field])


@pytest.mark.parametrize("name", SETS)
def test_a_batch_is_a_loop_over_single_simulations(name):
    robot = build_twin(parameter_set(name))
    batch = Batch(robot.model, 3, 2)
    starts = [moving(seed) for seed in range(3)]
    for field in ("qpos", "qvel", "act"):
        batch.bind(field)[:] = [getattr(s, field) for s in starts]
    batch.bind("ctrl")[:] = 0.7
    sensors = batch.bind("sensordata")
    batch.step(nstep=50)
    for k, at in enumerate(starts):
        data = mujoco.MjData(robot.model)
        data.qpos[:], data.qvel[:], data.act[:], data.ctrl[:] = at.qpos, at.qvel, at.act, 0.7
        for _ in range(50):
            mujoco.mj_step(robot.model, data)
        np.testing.assert_array_equal(batch.bind("qpos")[k], data.qpos)
        np.testing.assert_array_equal(sensors[k], data.sensordata)


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
