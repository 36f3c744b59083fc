"""Hidden effects: nothing at size zero, more with more size, and records that tell the truth."""

import numpy as np
import pytest
from joint_worlds import slots as at
from joint_worlds.files import write_world
from joint_worlds.hidden import EVERY, Habits
from joint_worlds.motion import ROBOTS, windows
from joint_worlds.seen import logged
from joint_worlds.world import LEAST, UnseenError, held_base, make_world, with_effect

from identification import read_robot

ROBOT = ROBOTS["two_link"]
HABITS = Habits(force=2.0, speed=3.0, travel=0.6, coulomb=0.2, damping=0.1, often=1.5)


def shown(robot, numbers):
    """Positions of a swing as a log would have them, without noise."""
    inputs = 2.0 * np.sin(np.arange(80)[:, None] / 7 + np.arange(robot.n))
    state = np.zeros((1, 4, robot.n))
    state[0, 1], state[0, 3] = 2.0, inputs[0]
    h = robot.sampling_time / 10
    return windows(robot.code, numbers.p, numbers.joints, np.array([0]), state, inputs,
                   np.zeros_like(inputs), 80, h, 10)[0]  # fmt: skip


def names():
    return [name for name in EVERY if EVERY[name].joints(ROBOT)]


@pytest.mark.parametrize("name", names())
def test_size_zero_is_no_effect_and_more_size_is_more(name):
    base, joint = held_base(ROBOT), EVERY[name].joints(ROBOT)[0]
    hidden, rng = EVERY[name], np.random.default_rng(0)
    if "coulomb" in hidden.known:
        base.joints[:, at.COULOMB] = 0.0
    shape = hidden.shape(HABITS, rng)
    sizes = [0.0, 0.3 * hidden.largest(HABITS), 0.6 * hidden.largest(HABITS)]
    many = [with_effect(ROBOT, base, name, joint, size, shape) for size in sizes]
    plain, none, some, more = (shown(ROBOT, numbers) for numbers in (base, *many))
    np.testing.assert_array_equal(none, plain)
    if name in ("time_shift", "encoder_lag"):  # the motion stays, the log is late
        states = np.zeros((80, 4, 2))
        states[:, 0] = plain
        states[:, 1] = np.gradient(plain, ROBOT.sampling_time, axis=0)
        plain, some, more = (logged(ROBOT, n.joints, states)[5:] for n in (base, *many[1:]))
    first, second = (np.abs(x - plain).max() for x in (some, more))
    assert 0 < first < second


def test_encoders_that_are_late_show_earlier_positions():
    base = held_base(ROBOT)
    t = ROBOT.sampling_time * np.arange(200)
    states = np.zeros((200, 4, 2))
    states[:, 0], states[:, 1] = np.sin(3 * t)[:, None], 3 * np.cos(3 * t)[:, None]
    late = with_effect(ROBOT, base, "encoder_lag", 1, 0.0123, {})
    y = logged(ROBOT, late.joints, states)
    np.testing.assert_array_equal(y[:, 0], states[:, 0, 0])
    np.testing.assert_allclose(y[5:, 1], np.sin(3 * (t[5:] - 0.0123)), atol=1e-8)  # Hermite's


@pytest.mark.long
def test_a_world_is_read_as_a_robot_and_repeats_itself(tmp_path):
    world, again = (make_world("cart", "offset", 4, duration=2.0) for _ in range(2))
    np.testing.assert_array_equal(world.records[0].outputs, again.records[0].outputs)
    assert world.acting == ()  # one effect acts, which is that of the world itself
    toml, a, b = write_world(world, tmp_path)
    robot = read_robot(toml, a, confirm=[b])
    assert set(robot.nominal_model.names) == set(world.truth)
    assert world.ratio >= LEAST
    np.testing.assert_allclose(robot.log.outputs, world.records[0].outputs, rtol=1e-8)
    for name, value in world.truth.items():
        assert value == pytest.approx(robot.plant.parameters[name].value, rel=0.1001)


def test_what_parameters_imitate_is_no_world():
    """A linear robot with a wrong scale is a linear robot with other parameters."""
    with pytest.raises(UnseenError, match="encoder_scale of cart shows"):
        make_world("cart", "encoder_scale", 1, duration=2.0)
