"""The model that needs MuJoCo only is the twin to first order about its start."""

import mujoco
import numpy as np
import pytest

from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.plain import build_plain
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin


@pytest.fixture(scope="module")
def twin():
    return build_twin()


@pytest.fixture(scope="module")
def plain():
    return build_plain().compile()


def motor_angles(model, currents):
    """Motor angles at 100 Hz, shape (N, 8) [rad]."""
    data, out = mujoco.MjData(model), []
    for current in currents:
        data.ctrl[:] = current
        mujoco.mj_forward(model, data)
        out.append([data.sensor(f"angle_{k}").data[0] for k in range(1, 9)])
        mujoco.mj_step(model, data, 10)
    return np.array(out)


def relative_error(twin, plain, currents):
    run = simulate(twin, currents)
    error = motor_angles(plain, currents) - run.motor_angle
    return np.sqrt(np.mean(error**2) / np.mean(run.motor_angle**2))


@pytest.mark.parametrize("values", [{}, {"x": 0.1, "z": 1.3, "yaw": 0.1, "m": 0.2}])
def test_it_rests_after_a_reset(values):
    model = build_plain(parameter_set("simulation", values)).compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 2000)
    assert np.abs(data.qpos - model.qpos0).max() < 1e-10
    assert data.qpos[2] == pytest.approx(values.get("z", 1.43), abs=1e-10)


def test_small_motions_are_the_twins_and_the_error_falls_with_the_square(twin, plain):
    """docs/models.md states 0.3 % at 5 mA and 1.1 % at 10 mA, about 0 A."""
    swing = (make_input("prbs", 2.0) - 0.75) / 0.25
    small, large = (relative_error(twin, plain, a * swing) for a in (0.005, 0.01))
    assert large < 0.012
    assert 3.0 < large / small < 5.0  # the friction's tanh is odd: its error is of third order


def test_large_motions_end_where_the_twins_do(twin, plain):
    """Where friction is saturated, the two agree again; docs/models.md states 0.4 %."""
    assert relative_error(twin, plain, make_input("prbs", 2.0)) < 0.01


def test_a_slack_cable_does_not_push():
    model = build_plain().compile()
    data = mujoco.MjData(model)
    slack = model.joint("spool_1").qposadr[0]
    data.qpos[slack] = -0.05  # 5 cm of cable paid out; 0.4 mm would do
    mujoco.mj_forward(model, data)
    dof = model.joint("spool_1").dofadr[0]
    spring = model.jnt_stiffness[model.joint("spool_1").id]
    stiffness = float(np.ravel(spring)[0])
    pull = stiffness * (model.qpos_spring[slack] - data.qpos[slack])
    assert data.qfrc_passive[dof] - data.qfrc_gravcomp[dof] == pytest.approx(pull)
