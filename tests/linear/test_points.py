"""Points, evaluated together, are what `mj_forward` says one by one."""

import ctypes
from unittest import mock

import mujoco
import numpy as np
import pytest
from effect_cases import full
from linear_cases import PENDULUM, compiled

from identification.errors import DivergenceError
from identification.linear import points as of_points
from identification.linear.operating_points import OperatingPoints
from identification.linear.points import Change, Points
from identification.model.protocol import list_differences, with_entries, with_numbers
from identification.model.rollout import without_sensors
from identification.native.forward import Intervals
from identification.runtime.engine import library, untimed

LIMITED = """<mujoco><option timestep="0.001"/><worldbody><body>
  <joint name="hinge" axis="0 1 0" range="-0.5 0.5" limited="true" frictionloss="0.05"/>
  <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.5" mass="1"/></body></worldbody>
  <actuator><motor name="torque" joint="hinge"/></actuator></mujoco>"""
FIELDS = {"qpos": "qpos", "qvel": "qvel", "act": "act", "ctrl": "inputs"}


def clock():
    return ctypes.c_void_p.in_dll(library(), "mjcb_time").value


def drawn(model, qpos, act, count=7, seed=0):
    rng = np.random.default_rng(seed)
    still = np.tile(qpos, (count, 1))
    return OperatingPoints(
        model=model,
        qpos=still + 0.01 * rng.normal(size=still.shape),
        qvel=rng.normal(0, 0.3, (count, model.nv)),
        act=np.tile(act, (count, 1)),
        inputs=rng.normal(0, 0.5, (count, model.nu)),
        time=rng.uniform(0, 1, count),
    )


def one_by_one(at, change):
    """The slow obvious way: a new mjData for each point."""
    model = with_entries(at.model, change.numbers)
    own = {f: change.fields.get(f, getattr(at, there)) for f, there in FIELDS.items()}
    rows = []
    for k, time in enumerate(at.time):
        data = mujoco.MjData(model)
        data.time = time
        for field, values in own.items():
            getattr(data, field)[:] = values[k]
        mujoco.mj_forward(model, data)
        rows.append(np.concatenate([data.qacc, data.act_dot]))
    return np.array(rows)


def twin():
    robot = full()
    state = robot.state()
    return robot, drawn(without_sensors(robot.model), state.qpos, state.act)


@pytest.mark.parametrize("threads", [1, 2, 20])
def test_the_twin_with_parameters_effects_states_and_inputs_moved(threads):
    robot, at = twin()
    names = ("lambda", "J", "m", "K_t", "x", "stribeck_friction.f_s", "pulley_radius.r_p")
    own = robot.parameters.values()
    values = np.tile([own[n] for n in names], (1 + len(names), 1))
    values[1:] += np.diag([1e-3 * v or 1e-3 for v in values[0]])
    numbers = robot.settings(names, values)[1]
    rows = range(1, 1 + len(names))
    changes = [Change({}, entries) for entries in list_differences(numbers, 0, rows)]
    assert {change.is_derived for change in changes} == {False, True}
    changes += [Change({f: 1.001 * getattr(at, there)}) for f, there in FIELDS.items()]
    changes += [Change(), Change({"ctrl": 0.9 * at.inputs}, changes[0].numbers)]
    with mock.patch.object(of_points, "threads", return_value=threads):
        together = list(Points(at).each(changes))
    scale = 1e-12 * np.abs(one_by_one(at, Change())).max(axis=0)  # shares are summed otherwise
    for change, rates in zip(changes, together, strict=True):
        assert (np.abs(rates - one_by_one(at, change)) <= scale).all()


def test_increments_are_averaged_over_intervals_with_each_course():
    robot, at = twin()
    values = np.array([[robot.parameters["lambda"].value]] * 2) * [[1.0], [1.001]]
    (entries,) = list_differences(robot.settings(("lambda",), values)[1], 0, [1])
    begins, weight = np.array([0, 2, 6]), np.array([0.3, 0.7, 0.1, 0.2, 0.3, 0.4, 1.0])
    courses = np.random.default_rng(1).uniform(size=(3, 7))
    changes = [Change({}, entries, courses), Change({"qpos": at.qpos + 1e-5}, entries)]
    unmoved = one_by_one(at, Change())
    with mock.patch.object(of_points, "threads", return_value=3):
        *each, whole = Points(at).each(changes, Intervals(begins, weight))
    for course, found in zip(courses, each, strict=True):
        moved = (one_by_one(at, changes[0]) - unmoved) * (course * weight)[:, None]
        np.testing.assert_allclose(found, np.add.reduceat(moved, begins), rtol=1e-9, atol=1e-9)
    moved = (one_by_one(at, changes[1]) - unmoved) * weight[:, None]
    np.testing.assert_allclose(whole, np.add.reduceat(moved, begins), rtol=1e-9, atol=1e-9)


def test_a_model_is_as_it_was_after_its_numbers_were_exchanged():
    robot, at = twin()
    values = np.array([[robot.parameters["lambda"].value]] * 2) * [[1.0], [1.1]]
    (entries,) = list_differences(robot.settings(("lambda",), values)[1], 0, [1])
    points = Points(at)
    before = points.rates()
    (moved,) = points.each([Change({}, entries)])
    assert not np.array_equal(moved, before)
    np.testing.assert_array_equal(points.rates(), before)


@pytest.mark.parametrize("xml", [PENDULUM, LIMITED], ids=["free", "constrained"])
def test_other_models_and_more_changes_than_are_taken_together(xml):
    model = compiled(xml)
    at = drawn(model, [0.499], [])
    count = of_points.TOGETHER + 3
    changes = [Change({"qvel": at.qvel + 0.1 * k, "ctrl": at.inputs - k}) for k in range(count)]
    for change, rates in zip(changes, Points(at).each(iter(changes)), strict=True):
        np.testing.assert_array_equal(rates, one_by_one(at, change))


def test_differences_written_into_a_copy_give_the_model_of_a_value_set():
    robot, _ = twin()
    own, names = robot.parameters.values(), ("m", "lambda", "b_c")
    values = np.array([own[n] for n in names]) * [[1.0, 1, 1], [1.1, 1, 1], [1, 1, 1.2]]
    numbers = robot.settings(names, values)[1]
    first = with_numbers(robot.model, numbers, 0)
    for row, entries in zip((1, 2), list_differences(numbers, 0, (1, 2)), strict=True):
        copy, whole = with_entries(first, entries), with_numbers(robot.model, numbers, row)
        assert Change({}, entries).is_derived == (row == 1)
        for field in ("body_mass", "body_inertia", "dof_invweight0", "actuator_user", "qpos0"):
            np.testing.assert_array_equal(getattr(copy, field), getattr(whole, field))


def test_what_is_not_finite_is_refused():
    at = drawn(compiled(PENDULUM), [0.1], [])
    with pytest.raises(DivergenceError, match="not finite"):
        Points(at).rates(qvel=np.full((7, 1), np.nan))


def test_switches_that_overlap_are_off_until_the_last_one_ends():
    switch = untimed
    read = clock
    before, first, second = read(), switch(), switch()
    first.__enter__()
    off = read()
    assert off != before
    second.__enter__()
    first.__exit__(None, None, None)
    assert read() == off
    second.__exit__(None, None, None)
    assert read() == before
