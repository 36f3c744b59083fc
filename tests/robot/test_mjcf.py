"""The MJCF with the values that were found predicts alone what the fitted robot predicts."""

import json

import mujoco
import numpy as np
import pytest
from servo_logs import DRAWN, LIFTING, goals, servo_log
from tracked_cases import robot

from identification import fit, read_robot
from identification.effects.catalogue import all_effects
from identification.model.predictor import Predictor
from identification.model.tied import value_of
from identification.robot import robot as made
from identification.robot.results.mjcf import write_mjcf

# degrees, a mesh in a folder of its own, and a body without a name
DEGREES = LIFTING.replace(
    '<compiler angle="radian"/>',
    '<compiler meshdir="shapes"/><asset><mesh name="shell" file="shell.obj"/></asset>',
).replace(
    '</body></body>\n</worldbody>',
    '<geom type="mesh" mesh="shell" contype="0" conaffinity="0"/></body></body>\n</worldbody>',
).replace('range="-1.5 2"', 'range="-86 115" springref="20" stiffness="0.3"').replace(
    'range="-0.4 2.4"', 'range="-30 140"'
).replace("<body>", '<body name="upper" euler="0 5 0">', 1)  # fmt: skip
OBJ = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
FREE = ("joint/lift.damping", "joint/bend.armature", "actuator/bend_goal.kp", "body/upper.mass",
        "joint/lift.stiffness")  # fmt: skip


@pytest.fixture
def written(tmp_path, few_effects):
    def write(free, more=""):
        (tmp_path / "shapes").mkdir(exist_ok=True)
        (tmp_path / "shapes" / "shell.obj").write_text(OBJ)
        log = servo_log(LIFTING, goals(samples=200))
        robot(tmp_path, LIFTING.format(**DRAWN), log)
        (tmp_path / "robot.xml").write_text(DEGREES.format(**DRAWN))
        head = f'model = "robot.xml"\nfree = {json.dumps([*free])}\ntrust = ["wiring"]\n'
        (tmp_path / "robot.toml").write_text(head + more)
        return read_robot(tmp_path / "robot.toml", tmp_path / "log.csv")

    return write


def predicted(own, values):
    """A free run of the robot with some values, from where its model begins."""
    plant = own.plant_of(own.log).with_values(values)
    return Predictor(plant, own.log, ()).predict(np.empty((1, 0)))[0], plant.bare.start


def alone(path, log, start):
    """The same by MuJoCo and the file alone."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    y = np.zeros(log.outputs.shape)
    data.qpos, data.qvel = start.qpos, start.qvel
    for k, u in enumerate(log.inputs):
        y[k], data.ctrl = data.qpos, u
        mujoco.mj_step(model, data, round(log.sampling_time / model.opt.timestep))
    return y


def test_alone_it_predicts_what_the_fitted_robot_does(tmp_path, written):
    own = written(FREE)
    values = dict(zip(FREE, (0.31, 0.02, 14.2, 0.37, 0.8), strict=True))
    (tmp_path / "out").mkdir()
    path = write_mjcf(own, values, tmp_path / "out" / "model.xml", tmp_path / "out")
    expected, start = predicted(own, values)
    moved = alone(path, own.log, start)
    assert np.ptp(expected, axis=0).min() > 0.5
    assert np.abs(predicted(own, {})[0] - expected).max() > 0.02
    # the numbers have six digits
    np.testing.assert_allclose(moved, expected, atol=2e-4)
    assert "has no place" not in path.read_text()


def test_a_payload_is_in_it_and_a_friction_by_a_function_is_named(tmp_path, written, monkeypatch):
    asked = ("coulomb_friction", "mass_mismatch")
    monkeypatch.setattr(
        made, "all_effects", lambda *given: [e for e in all_effects(*given) if e.name in asked]
    )
    payload, friction = "mass_mismatch.dm@upper", "coulomb_friction.f_c@lift"
    own = written(
        [FREE[0], payload, friction],
        f'[parameters."{payload}"]\nvalue = 0.1\n[parameters."{friction}"]\nvalue = 0.2\n',
    )
    path = write_mjcf(own, {payload: 0.15, friction: 0.0}, tmp_path / "model.xml", tmp_path)
    expected, start = predicted(own, {payload: 0.15, friction: 0.0})
    np.testing.assert_allclose(alone(path, own.log, start), expected, atol=2e-4)
    assert "has no place" not in path.read_text()
    path = write_mjcf(own, {payload: 0.15, friction: 0.3}, path, tmp_path)
    assert f"MJCF has no place for {friction} = 0.3." in path.read_text()


def test_a_limit_of_a_force_that_was_found_is_in_it_and_can_be_fitted_next(tmp_path, written):
    own = written(FREE[:1])
    path = write_mjcf(own, {}, tmp_path / "model.xml", tmp_path, limits={"lift_goal": 2.5})
    model = mujoco.MjModel.from_xml_path(str(path))
    np.testing.assert_allclose(model.actuator("lift_goal").forcerange, [-2.5, 2.5])
    assert list(model.actuator_forcelimited) == [name == "lift_goal" for name in _actuators(model)]
    assert value_of(model, "actuator/lift_goal.forcerange") == 2.5


def _actuators(model):
    return [model.actuator(k).name for k in range(model.nu)]


def test_a_fit_keeps_it_beside_the_toml(tmp_path, written):
    found = fit(written(FREE[:1]))
    found.save(tmp_path / "out")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / "model.xml"))
    assert model.dof_damping[0] == pytest.approx(found.values[FREE[0]], rel=1e-5)
    # and it is a model for the next log
    text = (tmp_path / "robot.toml").read_text().replace("robot.xml", "out/model.xml")
    (tmp_path / "next.toml").write_text(text)
    read_robot(tmp_path / "next.toml", tmp_path / "log.csv")
