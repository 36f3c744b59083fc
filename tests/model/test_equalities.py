"""Joints that equalities tie to measured ones begin where the equalities hold."""

import mujoco
import numpy as np
import pytest

from identification import fit, read_robot
from identification.model.equalities import put_tied, tied_joints
from identification.model.predictor import Predictor
from identification.windows.windows import first_states, windows

CHAIN = """<mujoco><worldbody><body name="one">
<joint name="a" axis="0 1 0" ref="{ref}"/>
<inertial pos="0 0 -0.1" mass="1" diaginertia="0.01 0.01 0.01"/>
<body pos="0 0 -0.3"><joint name="b" type="slide" axis="0 0 1"/>
<inertial pos="0 0 0" mass="0.1" diaginertia="0.001 0.001 0.001"/>
<body><joint name="c" axis="0 1 0"/><inertial pos="0 0 -0.1" mass="1" diaginertia="0.01 0.01 0.01"/>
</body></body></body></worldbody><equality>{ties}</equality></mujoco>"""
CURVED = '<joint joint1="b" joint2="a" polycoef="0.1 0.5 -0.2 0.3 0.05"/>'
STRAIGHT = '<joint joint1="c" joint2="b" polycoef="0.2 -4 0 0 0"/>'
A, B, C = range(3)


@pytest.mark.parametrize(("ties", "known", "told"), [
    (CURVED, [A], [B]), (STRAIGHT, [C], [B]), (CURVED + STRAIGHT, [A], [B, C]),
    (STRAIGHT, [B], [C]), (CURVED, [B], []), (CURVED, [A, B], []), ("", [A], []),
    (CURVED.replace("<joint", '<joint active="false"'), [A], []),
])  # fmt: skip
def test_tied_joints_stand_and_move_as_the_equalities_want(ties, known, told):
    model = mujoco.MjModel.from_xml_string(CHAIN.format(ties=ties, ref=30))
    assert [joint for joint, _, _ in tied_joints(model, known)] == told
    q, v = np.random.default_rng(4).uniform(-1, 1, (2, 5, 3))
    before = q.copy(), v.copy()
    put_tied(model, known, q, v)
    rest = np.setdiff1d(range(3), told)
    assert (q[:, rest] == before[0][:, rest]).all()
    assert (v[:, rest] == before[1][:, rest]).all()
    if not told:
        return
    data = mujoco.MjData(model)
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    for data.qpos[:], data.qvel[:] in zip(q, v, strict=True):
        mujoco.mj_forward(model, data)
        rows = slice(0, data.ne)
        assert data.efc_pos[rows] == pytest.approx(0, abs=1e-12)
        assert data.efc_J.reshape(-1, 3)[rows] @ data.qvel == pytest.approx(0, abs=1e-12)


# The motor at the base turns the knee by a belt, so that a light hub beneath the hip turns back.
BELT = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody><body pos="0 0 1">
<joint name="hip" axis="0 1 0" damping="0.06" armature="0.004"/>
<inertial pos="0 0 -0.11" mass="0.8" diaginertia="0.006 0.006 0.0004"/>
<body pos="0 0 -0.25"><joint name="back" axis="0 1 0"/>
<inertial pos="0 0 0" mass="0.002" diaginertia="2e-6 2e-6 2e-6"/>
<body><joint name="knee" axis="0 1 0" damping="0.02" armature="0.001"/>
<inertial pos="0 0 -0.09" mass="0.3" diaginertia="0.001 0.001 0.0001"/></body></body></body>
</worldbody>
<equality><joint joint1="back" joint2="hip" polycoef="0 -1 0 0 0"/></equality>
<actuator><motor name="u1" joint="hip" gear="{gear}"/><motor name="u2" joint="knee" gear="0.5"/>
</actuator><sensor><jointpos name="hip" joint="hip"/><jointpos name="knee" joint="knee"/></sensor>
</mujoco>"""
TOML = """model = "robot.xml"
free = ["gain"]
horizon = 0.3
trust = ["units", "wiring"]
[parameters.gain]
path = "actuator/u1.gear[0]"
known = 1.0
"""


def test_an_arm_with_a_belt_is_fitted_where_nothing_measures_the_hub(tmp_path):
    model = mujoco.MjModel.from_xml_string(BELT.format(gear=1.5))
    data, rng, table = mujoco.MjData(model), np.random.default_rng(0), np.zeros((500, 5))
    data.qpos[:] = 0.4, -0.4, 0
    for k in range(len(table)):
        if k % 40 == 0:
            data.ctrl[:] = rng.uniform(-1, 1, 2)
        mujoco.mj_forward(model, data)
        table[k] = 0.01 * k, *data.ctrl, *data.sensordata
        mujoco.mj_step(model, data, 5)
    table[:, 3:] += 2e-4 * rng.standard_normal((len(table), 2))
    (tmp_path / "robot.xml").write_text(BELT.format(gear=5))  # a free run turns on and on
    (tmp_path / "robot.toml").write_text(TOML)
    log = tmp_path / "log.csv"
    np.savetxt(log, table, "%.9g", ",", header="time,u1,u2,hip,knee", comments="")
    robot = read_robot(tmp_path / "robot.toml", log)
    free = Predictor(robot.plant, robot.log, (), {})
    first = first_states(free, np.zeros(0), windows(robot.log, 0.3))
    for x in (first.states.qpos, first.states.qvel, robot.plant.bare.start.qpos[None]):
        assert np.ptp(x[:, 0]) > 0.5 or len(x) == 1
        assert x[:, 1] == pytest.approx(-x[:, 0], abs=1e-12)
    assert robot.plant.bare.start.qpos[0] == pytest.approx(0.4, abs=1e-3)
    found = fit(robot)
    assert abs(found.values["gain"] - 1.5) < 4 * found.std["gain"]
    assert found.std["gain"] < 0.01
