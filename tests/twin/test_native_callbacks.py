"""The callbacks are global in MuJoCo: they must leave alone what is not theirs, and say so."""

import ctypes
import threading
from pathlib import Path

import mujoco
import numpy as np
import pytest
from mujoco.batch import Batch

from identification.errors import DivergenceError, InputError
from identification.model.rollout import State
from identification.native import structs
from identification.native.table import uninstall
from inca_mj.robot import law
from inca_mj.robot.inputs import make_input
from inca_mj.twin import native
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

# User actuators, tendons and sensors with user data wide enough to be mistaken for the robot's.
ORDINARY = f"""<mujoco>
  <size nuser_actuator="{law.ACTUATOR_COLUMNS}" nuser_tendon="{law.TENDON_COLUMNS}"
        nuser_sensor="1"/>
  <option integrator="RK4"/>
  <worldbody>
    <site name="a" pos="0 0 2"/>
    <body pos="0 0 1">
      <joint name="j" axis="0 1 0"/><geom size="0.1" pos="0.2 0 0"/>
      <site name="b" pos="0.3 0 0"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="t" user="3 2 1" stiffness="5" damping="0.1">
      <site site="a"/><site site="b"/>
    </spatial>
  </tendon>
  <actuator>
    <general name="u" joint="j" dyntype="user" actdim="1" biastype="user" gaintype="fixed"
             gainprm="1" user="1 2 3 4 5 6 7 0"/>
    <general name="w" tendon="t" dyntype="integrator" user="6207.9 2 3 4 5 6 7 0"/>
  </actuator>
  <sensor>
    <user name="s" objtype="actuator" objname="u" dim="1" needstage="vel" user="1"/>
    <user name="r" dim="2" needstage="pos"/>
  </sensor>
</mujoco>"""


@pytest.fixture(autouse=True)
def installed():
    """Every test begins and ends with the law in place."""
    native.install()
    yield
    uninstall()
    native.install()


def trajectory(model):
    data = mujoco.MjData(model)
    data.ctrl[:] = 0.3
    data.act[:] = 0.1
    rows = []
    for _ in range(500):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
    return np.array(rows)


def test_other_models_are_untouched():
    model = mujoco.MjModel.from_xml_string(ORDINARY)
    with_law = trajectory(model)
    uninstall()
    np.testing.assert_array_equal(with_law, trajectory(model))
    assert np.ptp(with_law[:, 0]) > 0.1


@pytest.mark.parametrize("name", ["passive", "sensor"])
def test_a_foreign_callback_is_refused_and_left_in_place(name):
    uninstall()

    def foreign(*_):
        return 0.0

    getattr(mujoco, f"set_mjcb_{name}")(foreign)
    try:
        with pytest.raises(InputError, match=f"mjcb_{name}"):
            native.install()
        assert getattr(mujoco, f"get_mjcb_{name}")() is foreign
        others = {"passive", "act_dyn", "act_bias", "sensor"} - {name}
        assert all(getattr(mujoco, f"get_mjcb_{other}")() is None for other in others)
    finally:
        getattr(mujoco, f"set_mjcb_{name}")(None)


def test_the_declared_layout_is_where_live_fields_are():
    model = build_twin().model
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert {"actuator_user", "tendon_user", "ten_J", "act", "qfrc_passive"} <= structs.check(
        model, data
    )


@pytest.mark.parametrize("moved", ["nv", "qfrc_passive"])
def test_a_field_elsewhere_is_caught(moved, monkeypatch):
    true = structs.layout

    def shifted(struct):
        layout = true(struct)
        fields = dict(layout._fields_)
        if moved not in fields:
            return layout
        padded = [("gap", ctypes.c_int64)] if moved in fields else []
        cut = list(fields).index(moved)
        entries = list(layout._fields_)
        return type(struct, (ctypes.Structure,),
                    {"_fields_": entries[:cut] + padded + entries[cut:]})  # fmt: skip

    model = build_twin().model
    data = mujoco.MjData(model)
    monkeypatch.setattr(structs, "layout", shifted)
    with pytest.raises(RuntimeError, match="is not where its"):
        structs.check(model, data)


def test_nan_is_an_error_not_silence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    robot = build_twin()
    at = robot.state()
    act = at.act.copy()
    act[2] = np.nan
    with pytest.raises(DivergenceError, match="diverged at t = 0"):
        simulate(robot, make_input("zero", 0.1), start=State(at.qpos, at.qvel, act))
    assert list(Path(tmp_path).iterdir()) == []


def test_a_rollout_runs_without_the_interpreters_lock():
    robot = build_twin()
    batch = Batch(robot.model, 2, 2)
    at = robot.state()
    batch.bind("qpos")[:], batch.bind("act")[:] = at.qpos, at.act
    batch.rollout(10)
    seen, done = [], threading.Event()

    def count():
        while not done.is_set():
            seen.append(len(seen))
            done.wait(1e-3)

    other = threading.Thread(target=count)
    other.start()
    before = len(seen)
    batch.rollout(10_000)  # a quarter of a second or more
    during = len(seen) - before
    done.set()
    other.join()
    # With the lock held, the other thread would stand still.
    assert during > 20
