"""RK4 of order 4, where the motion is smooth; of order 2, where MuJoCo turns a quaternion."""

import mujoco
import numpy as np
import pytest

from inca_mj.reference import layout as at
from inca_mj.reference import rest, simulate_reference
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.verification.order import slope
from inca_mj.verification.states import to_mujoco

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
    return lambda h: (
        simulate_reference(
            parameter_set(), INCA, TIME, LIFT, start=start, method="rk4", step=h
        ).angles
    )  # fmt: skip


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
