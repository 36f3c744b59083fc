"""Effects of sensors: readings by hand, in runs and in windows."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from joint_cases import ARM, DAMPING, MASS, SLIDER, arm_log, run, slider, slider_log, steps
from plain_logs import plain_log

from identification.effects.axes import Axis
from identification.effects.plant.joint_plant import joint_plant
from identification.model.predictor import Predictor
from identification.model.rollout import State
from identification.native.reading import Reading
from identification.windows.window_error import window_error
from identification.windows.window_estimate import estimate_windows

BOTH = SLIDER.replace("</sensor>", '<jointvel name="rate" joint="slide"/></sensor>')
S = Reading(y=2.0, q=0.7, v=-3.0, time=1.2, k=0, signals=0, samples=1)
DELAY = {"encoder_lag.kind": 1.0}
LAWS = [
    ("encoder_scale", (0.1,), 0.2),
    ("encoder_offset", (0.1,), 0.1),
    ("encoder_eccentricity", (0.2, 0.3), 0.2 * np.cos(0.7) + 0.3 * np.sin(0.7)),
]


@cache
def arm(turns=4.0):
    """The arm with a log in which each joint moves by so many radians or twice as much."""
    log = arm_log(steps(100, 2))
    return joint_plant(ARM, (), replace(log, outputs=turns * log.outputs))


def effects():
    return {e.name: e for e in arm().effects if "reading" in e.hooks}


@pytest.mark.parametrize(("name", "p", "expected"), LAWS)
def test_a_reading_is_what_the_equation_says(name, p, expected):
    law = effects()[name].hooks["reading"]
    assert law.py_func(S, p) == pytest.approx(expected, rel=1e-14)


def test_every_effect_of_a_sensor_is_held_against_its_equation():
    assert {name for name, *_ in LAWS} | {"encoder_lag"} == effects().keys()


@pytest.mark.parametrize(("turns", "there"), [(0.5, ()), (1.7, ("sensor b",)), (4.0, "ab")])
def test_a_disc_is_asked_where_its_joint_moves_by_half_a_turn(turns, there):
    found = [e for e in arm(turns).effects if e.name == "encoder_eccentricity"]
    single = [where for e in found for where, at in e.places.items() if at or len(e.places) == 1]
    assert single == [w if " " in w else f"sensor {w}" for w in there]


def test_the_readings_of_an_arm_are_those_by_hand():
    log = arm_log(steps(100, 2))
    q = run(arm(), log)
    both = {"encoder_scale.s": 0.02, "encoder_scale.s@a": 0.01, "encoder_offset.c@b": 0.3,
            "encoder_eccentricity.a": 0.01, "encoder_eccentricity.b@b": 0.02}  # fmt: skip
    a = 1.03 * q[:, 0] + 0.01 * np.cos(q[:, 0])
    b = 1.02 * q[:, 1] + 0.3 + 0.01 * np.cos(q[:, 1]) + 0.02 * np.sin(q[:, 1])
    np.testing.assert_allclose(run(arm(), log, **both), np.stack([a, b], axis=1), rtol=1e-14)


@pytest.mark.parametrize("tau", [3, 14])
def test_a_lag_is_the_reading_so_many_milliseconds_earlier(tau):
    u = steps(100, 2)
    late = run(
        arm(),
        arm_log(u),
        **DELAY,
        **{"encoder_lag.tau@a": 1e-3 * tau, "encoder_lag.tau@b": 1e-3 * tau},
    )
    each = replace(arm_log(np.repeat(u, 10, axis=0)), time=1e-3 * np.arange(1000))
    q = run(arm(), each)
    k = np.arange(10, 90)
    error, moved = late[k] - q[10 * k - tau], q[10 * k] - q[10 * k - tau]
    assert np.abs(error).max() < 1e-4 * np.abs(moved).max()


@pytest.mark.parametrize("tau", [2e-3, 0.03])
def test_a_first_order_lag_is_that_of_the_motion_between_samples(tau):
    """Its equation, solved in steps of a millisecond along the motion."""
    u = steps(100, 2)
    late = run(arm(), arm_log(u), **{"encoder_lag.tau@a": tau, "encoder_lag.tau@b": tau})
    each = replace(arm_log(np.repeat(u, 10, axis=0)), time=1e-3 * np.arange(1000))
    q = run(arm(), each)
    x, keep, mean = q.copy(), np.exp(-1e-3 / tau), tau / 1e-3 * (1 - np.exp(-1e-3 / tau))
    for k in range(999):  # the input moves straight from q_k to q_(k+1)
        x[k + 1] = q[k + 1] + keep * (x[k] - q[k]) - mean * (q[k + 1] - q[k])
    error, moved = late - x[::10], x[::10] - q[::10]
    assert np.abs(error).max() < 2e-3 * np.abs(moved).max()


def test_a_lag_of_whole_samples_is_exact():
    log = arm_log(steps(50, 2))
    q = run(arm(), log)
    for n in (1, 3):
        late = run(arm(), log, **DELAY, **{"encoder_lag.tau@a": 0.01 * n})
        np.testing.assert_allclose(late[n:, 0], q[:-n, 0], atol=1e-12)


def test_each_value_set_of_a_batch_has_its_readings_and_a_rate_is_scaled_only():
    u = steps(100)
    log = plain_log(u, np.stack([np.sin(u[:, 0]), u[:, 0]], axis=1), "force", "position rate")
    axis = Axis("slide", "slide", force=5.0, speed=1.0, travel=1.0)
    plant = joint_plant(BOTH, (MASS, DAMPING), log, joints=(axis,))
    known = {e.name: set(e.places.values()) for e in plant.effects if "reading" in e.hooks}
    assert known == {"encoder_scale": {"", "@position", "@rate"}, "encoder_offset": {"@position"},
                     "encoder_lag": {"@position"}}  # fmt: skip
    names = ("encoder_scale.s@rate", "encoder_offset.c@position")
    many = Predictor(plant, log, names).predict(np.array([[0.0, 0.0], [0.1, 0.0], [0.1, -2.0]]))
    np.testing.assert_allclose(many[1], many[0] * [1.0, 1.1], rtol=1e-14)
    np.testing.assert_allclose(many[2], many[1] - [2.0, 0.0], rtol=1e-14)


def test_windows_begin_at_the_true_state_and_not_at_the_measured_one():
    log = arm_log(steps(200, 2))
    plant = arm()
    wrong = {"encoder_offset.c@a": 0.2, "encoder_scale.s@b": 0.03}
    measured = arm_log(steps(200, 2))
    measured = replace(log, outputs=run(plant, log, **wrong))
    error = window_error(plant, measured, 0.25, wrong)
    assert np.sqrt(np.mean(error**2)) < 1e-6
    # an arm under gravity feels a wrong zero: no start of the windows makes up for it
    assert np.sqrt(np.mean(window_error(plant, measured, 0.25) ** 2)) > 1e-4
    fit = estimate_windows(plant, measured, tuple(wrong), 0.25, {n: 0.01 for n in wrong})
    for name, value in wrong.items():
        assert fit.values[name] == pytest.approx(value, rel=0.02)


def coasting(**values):
    """Position of the slider (m = 2, d = 3) that begins at 1 m/s and is not driven, (N,)."""
    log = slider_log(steps(400))
    start = State(np.zeros(1), np.ones(1), np.zeros(0))
    plant = joint_plant(SLIDER, (MASS, DAMPING), log, start=start)
    return run(plant, slider_log(np.zeros((400, 1))), **values)[:, 0]


def test_a_viscous_friction_that_drifts_and_jumps_slows_as_its_integral_says():
    t = 0.01 * np.arange(400)
    v = np.gradient(coasting(**{"viscous_friction_drift.d_t@slide": 2.0}), t)
    np.testing.assert_allclose(v[1:-1], np.exp(-(3 * t + t**2) / 2)[1:-1], atol=1e-4)
    jump = {"viscous_friction_jump.d_j@slide": 4.0, "viscous_friction_jump.t_j": 0.5,
            "viscous_friction_jump.w": 0.02}  # fmt: skip
    v = np.gradient(coasting(**jump), t)
    expected = np.exp(-(3 * t + 4 * np.clip(t - 0.5, 0, None)) / 2)
    np.testing.assert_allclose(v[1:-1], expected[1:-1], atol=5e-3)


def test_a_push_gives_its_impulse():
    values = {"push.f_p@slide": 6.0, "push.t_0": 0.5, "push.t_p": 0.25, "push.w": 0.05}
    far = coasting(**values)[-1] - coasting()[-1]
    assert far == pytest.approx(6 * 0.25 / 3, rel=0.01)  # impulse over damping, when all is at rest


def test_the_time_of_a_jump_is_found():
    u = steps(400, hold=15)
    name = "viscous_friction_jump.d_j@slide"
    true = {name: 2.0, "viscous_friction_jump.t_j": 1.37}
    y = run(slider(), slider_log(u), **true)
    log = slider_log(u, y + 1e-5 * np.random.default_rng(1).standard_normal(y.shape))
    free = ("damping", name, "viscous_friction_jump.t_j")
    begun = {name: 1.0, "viscous_friction_jump.t_j": 1.25}  # of the grid, the nearest one
    fit = estimate_windows(slider(), log, free, 0.2, begun)
    assert abs(fit.values[free[2]] - 1.37) < 4 * fit.std[2] < 0.05
    assert fit.values[name] == pytest.approx(2.0, rel=0.02)
