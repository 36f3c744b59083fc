"""Friction of a pendulum that is let go: it holds, it stops, and it takes its work."""

import numpy as np
import pytest
from joint_cases import STEP, run

from identification import Log, Parameter
from identification.effects.joint_plant import joint_plant

PENDULUM = """<mujoco model="pendulum">
  <option timestep="0.005" integrator="RK4"/>
  <worldbody><body><joint name="hinge" axis="0 1 0"/>
    <inertial pos="0 0 -0.1" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/></body></worldbody>
  <actuator><motor name="drive" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>"""
WEIGHT = 0.5 * 9.81 * 0.1  # of the arm, level [N m]


def released(angle, seconds=5.0, **values):
    """Angle of a pendulum that is let go without a drive, shape (N,)."""
    t = np.arange(round(seconds / STEP)) * STEP
    log = Log(
        time=t, inputs=1e-12 * np.sin(t)[:, None], outputs=np.sin(t)[:, None],
        input_names=("drive",), output_names=("angle",),
    )  # fmt: skip
    start = Parameter(name="q", value=0.0, unit="rad", where="qpos[0]", scale=0.1)
    plant = joint_plant(PENDULUM, (start,), log)
    return run(plant, log, q=angle, **values)[:, 0]


@pytest.mark.parametrize(
    ("name", "size"),
    [("coulomb_friction.f_c", 1.02 * WEIGHT * np.sin(0.6)), ("gravity_load_friction.mu", 1.02),
     ("transmitted_load_friction.mu", 1.02)],
)  # fmt: skip
def test_friction_holds_what_drives_less_and_does_not_creep(name, size):
    q = released(0.6, **{f"{name}@hinge": size})
    assert np.abs(q - 0.6).max() < 1e-12


@pytest.mark.parametrize("name", ["gravity_load_friction.mu", "transmitted_load_friction.mu"])
def test_friction_under_load_lets_go_what_drives_more(name):
    q = released(0.6, **{f"{name}@hinge": 0.98})
    assert q[-1] < 0.59


def test_coulomb_friction_stops_a_pendulum_where_it_holds():
    f_c = 0.3 * WEIGHT
    q = released(1.2, seconds=8.0, **{"coulomb_friction.f_c@hinge": f_c})
    assert np.ptp(q[-100:]) < 1e-12  # at rest
    assert abs(WEIGHT * np.sin(q[-1])) < f_c


def test_coulomb_friction_takes_its_work_from_a_swing():
    """From rest to rest the weight's work is f_c times the way, but for the last T of it."""
    f_c = 0.1 * WEIGHT
    q = released(1.0, seconds=2.0, **{"coulomb_friction.f_c@hinge": f_c})
    turn = int(np.argmin(q))
    fallen = WEIGHT * (np.cos(q[turn]) - np.cos(q[0]))
    assert fallen == pytest.approx(f_c * (q[0] - q[turn]), rel=0.03)
