"""RK4 of order 4, where the motion is smooth; of order 2, where MuJoCo turns a quaternion."""

from dataclasses import fields

import mujoco
import numpy as np
import pytest
from effect_cases import full

from inca_mj.reference import derivative, pack, rest, simulate_reference
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import SETS, parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.statics import start_from, starts_from
from inca_mj.twin.twin import build_twin
from inca_mj.verification.derivatives import to_mujoco
from inca_mj.verification.trajectories import slope

COARSE = (1e-3, 5e-4, 2.5e-4)
FINE = (2.5e-4, 1.25e-4, 6.25e-5)
TIME = np.arange(21) * 0.01
LIFT = np.tile([0.2] * 4 + [0.6] * 4, (21, 1))  # the same in all upper drives: it does not turn


def errors(start, steps, by):
    exact = simulate_reference(parameter_set(), INCA, TIME, LIFT, start=start)
    assert exact.tension.min() > 1
    return [float(np.abs(by(h) - exact.angles).max()) for h in steps]


def of_the_twin(start):
    state = to_mujoco(start)
    return lambda h: simulate(build_twin(timestep=h), LIFT, start=state).motor_angle


def of_the_reference(start):
    """Angles by the classic Runge-Kutta method with step h, as the twin's but in Euler angles."""
    q = pack(parameter_set(), INCA)

    def angles(h):
        rows, x = [start], start
        for current in LIFT[:-1]:
            for _ in range(round(0.01 / h)):
                k_1 = derivative(x, current, q)
                k_2 = derivative(x + h / 2 * k_1, current, q)
                k_3 = derivative(x + h / 2 * k_2, current, q)
                k_4 = derivative(x + h * k_3, current, q)
                x = x + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4)
            rows.append(x)
        return np.array(rows)[:, at.ANGLES]

    return angles


def test_order_4_when_the_handle_moves_without_turning():
    start = rest(parameter_set(), INCA).state
    measured = slope(COARSE, errors(start, COARSE, of_the_twin(start)))
    assert measured == pytest.approx(4, abs=0.2)


@pytest.mark.skipif(
    int(mujoco.__version__.split(".")[0]) > 3, reason="MuJoCo 4 integrates turns to fourth order"
)
def test_order_2_is_left_when_it_turns_and_it_is_the_quaternions():
    start = rest(parameter_set(), INCA).state.copy()
    start[at.RATES] = 3.0, -2.0, 5.0
    ours = errors(start, FINE, of_the_twin(start))
    assert slope(FINE, ours) == pytest.approx(2, abs=0.4)
    # RK4 on the same motion in Euler angles knows no such error.
    assert errors(start, FINE[1:2], of_the_reference(start))[0] < ours[1] / 2


OFF = {"x": 0.04, "y": -0.03, "z": 1.5, "roll": 0.1, "pitch": -0.05, "yaw": 0.15}


@pytest.mark.parametrize("values", [{}, OFF], ids=["nominal", "off-nominal"])
@pytest.mark.parametrize("name", SETS)
def test_at_rest_it_stays_for_ten_seconds(name, values):
    robot = build_twin(parameter_set(name, values))
    run = simulate(robot, make_input("zero", 10.0))
    assert np.abs(run.position - run.position[0]).max() < 1e-9
    assert np.abs(run.motor_angle).max() < 1e-7
    np.testing.assert_allclose(run.tension, np.tile(robot.start.tension, (1001, 1)), atol=1e-7)


@pytest.mark.parametrize("seed", range(2))
def test_starts_that_are_shared_are_those_of_each_value_set(seed):
    robot = full(settled=True)
    rng, own = np.random.default_rng(seed), robot.parameters.values()
    names = [*own]
    values = np.tile(list(own.values()), (1 + len(names), 1))
    values[1 + np.arange(len(names)), np.arange(len(names))] += rng.uniform(1e-5, 1e-4, len(names))
    shared = starts_from(own, names, values, robot.geometry, robot.layout)
    assert len({id(start) for start in shared}) < 0.7 * len(shared)
    for row, start in zip(values, shared, strict=True):
        alone = start_from(dict(zip(names, row, strict=True)), robot.geometry, robot.layout)
        for field in fields(start):
            np.testing.assert_array_equal(getattr(start, field.name), getattr(alone, field.name))
