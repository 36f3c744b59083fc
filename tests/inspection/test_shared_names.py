"""Where an actuator bears the name of its joint, the columns beside it tell which is whose."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from touching_cases import simulated

from identification import fit, inspect_log, read_robot
from identification.inspection.beginning import write_beginning
from identification.inspection.channels import Channel
from identification.inspection.matching import match

pytestmark = pytest.mark.usefixtures("few_effects")
LIFT = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<body><joint name="lift" type="slide" axis="1 0 0" damping="4"/>
  <inertial pos="0 0 0" mass="2.5" diaginertia="0.02 0.02 0.02"/>
  <body><joint name="Tilt2" axis="0 1 0" damping="0.1"/><site name="tip" pos="0 0 -0.3"/>
  <inertial pos="0 0 -0.15" mass="0.7" diaginertia="0.01 0.01 0.002"/></body></body></worldbody>
<actuator><{0} name="lift" joint="lift" {1}/><{0} name="Tilt2" joint="Tilt2" {1}/></actuator>
<sensor>{2}</sensor></mujoco>"""
KP, WRONG = 31.0, 25.0
JOINTS = ("lift", "Tilt2")
OWN = "".join(f'<jointpos name="{j}" joint="{j}"/>' for j in JOINTS)  # as the actuators are called


def lift(kp=WRONG, sensors="", kind="position"):
    return LIFT.format(kind, f'kp="{kp}" kv="3"' if kind == "position" else "", sensors)


@pytest.fixture(scope="module")
def log():
    sensors = OWN.replace('name="', 'name="a')
    return simulated(lift(KP, sensors), samples=500, noise=1e-5)


def begun(folder, log, columns, text=None):
    """What `new` says of a log with columns of these names, and the file that it writes."""
    (folder / "lift.xml").write_text(text or lift())
    data = {"time": log.time}
    for name, values in columns.items():
        data |= {name.format(j): x for j, x in zip(JOINTS, values.T, strict=True)}
    table = np.column_stack([*data.values()])
    np.savetxt(folder / "log.csv", table, "%.9g", ",", header=",".join(data), comments="")
    said = write_beginning(inspect_log(folder / "log.csv"), folder / "lift.xml", folder / "r.toml")
    return said, tomllib.loads((folder / "r.toml").read_text())


@pytest.mark.parametrize(("told", "seen"), [
    ("{}_cmd", "{}"), ("{}_des", "{}"), ("goal_{}", "{}"), ("{}.ref", "{}"), ("{}", "{}_pos"),
    ("{}", "encoder.{}"), ("{}_target", "{}_pos"), ("action.{}", "observation.{}"),
    ("{}_soll", "{}_ist"), ("{}_first", "{}"), ("{}", "{}_second"), ("action.{}", "{}"),
])  # fmt: skip
@pytest.mark.parametrize("sensors", ["", OWN])
def test_a_fit_reads_the_file_that_is_written(tmp_path, log, told, seen, sensors):
    columns = {seen: log.outputs, told: log.inputs}  # in the other order than usual, too
    said, content = begun(tmp_path, log, columns, lift(sensors=sensors))
    assert said.needs == ()
    named = {"lift": "lift", "Tilt2": "Tilt2"}
    expected = {j: told.format(j) for j in named}
    expected |= {f"{j}_position": seen.format(j) for j in named}
    assert content["columns"] == expected
    robot = read_robot(tmp_path / "r.toml", tmp_path / "log.csv")
    assert np.allclose(robot.log.outputs, log.outputs, atol=1e-7)
    assert np.allclose(robot.log.inputs, log.inputs, atol=1e-7)


@pytest.mark.parametrize("sensors", ["", OWN])
def test_the_fit_finds_the_gain(tmp_path, log, sensors):
    begun(tmp_path, log, {"{}_cmd": log.inputs, "{}": log.outputs}, lift(sensors=sensors))
    found = fit(read_robot(tmp_path / "r.toml", tmp_path / "log.csv"))
    assert found.values["actuator/lift.kp"] == pytest.approx(KP, rel=0.01)
    assert found.values["actuator/Tilt2.kp"] == pytest.approx(KP, rel=0.01)


def test_a_log_of_one_column_each_is_told_what_is_missing(tmp_path, log):
    said, content = begun(tmp_path, log, {"{}": log.outputs})
    assert content["columns"] == {f"{j}_position": j for j in JOINTS}
    (need,) = said.needs
    assert need.startswith("lift, Tilt2: each is the name of an actuator and of what it drives")
    assert 'such as lift = "lift_cmd"' in need


def test_a_measured_current_is_no_command_of_a_servo(tmp_path, log):
    columns = {"{}_cmd": log.inputs, "{}_current": log.outputs - 1, "{}": log.outputs}
    said, content = begun(tmp_path, log, columns)
    assert said.needs == ()
    assert content["columns"]["Tilt2"] == "Tilt2_cmd"
    assert content["columns"]["Tilt2_position"] == "Tilt2"
    del columns["{}_cmd"]
    (tmp_path / "alone").mkdir()
    said, content = begun(tmp_path / "alone", log, columns)
    assert content["columns"] == {f"{j}_position": j for j in JOINTS}
    assert len(said.needs) == 1


def test_a_motor_takes_the_torque(tmp_path, log):
    columns = {"{}_torque": log.inputs, "{}": log.outputs}
    content = begun(tmp_path, log, columns, lift(kind="motor"))[1]
    assert content["columns"]["lift"] == "lift_torque"
    assert content["columns"]["lift_position"] == "lift"


def test_of_two_columns_that_may_be_the_command_none_is_taken(tmp_path, log):
    columns = {"{}_cmd": log.inputs, "{}_goal": log.inputs, "{}": log.outputs}
    said, content = begun(tmp_path, log, columns)
    assert content["columns"] == {f"{j}_position": j for j in JOINTS}
    assert any("no column was found for actuator lift" in need for need in said.needs)


def test_a_model_with_other_sensors_gets_those_of_the_measured_joints(tmp_path, log):
    columns = {"{}_cmd": log.inputs, "{}": log.outputs}
    said, content = begun(tmp_path, log, columns, lift(sensors='<gyro name="imu" site="tip"/>'))
    assert said.needs == ()
    assert content["outputs"] == ["lift_position", "Tilt2_position"]
    assert read_robot(tmp_path / "r.toml", tmp_path / "log.csv").log.outputs.shape == (500, 2)


@pytest.mark.parametrize("sensors", ["", OWN, '<gyro name="imu" site="tip"/>'])
def test_an_output_that_bears_an_actuators_name_is_told_its_own(tmp_path, log, refusal, sensors):
    begun(tmp_path, log, {"{}_cmd": log.inputs, "{}": log.outputs}, lift(sensors=sensors))
    text = (tmp_path / "r.toml").read_text()
    (tmp_path / "r.toml").write_text(
        text.replace('["lift_position", "Tilt2_p', '["lift", "Tilt2_p')
    )
    said = refusal(read_robot, tmp_path / "r.toml", tmp_path / "log.csv")
    assert "lift is an actuator of" in said
    assert 'write "lift_position", the sensor, in its place' in said


def test_a_name_that_an_actuator_has_too_is_left_to_it(tmp_path, log):
    """The position of a joint gets a name that is free, whatever its actuators are called."""
    more = '<position name="lift_position" joint="lift"/></actuator>'
    text = lift().replace("</actuator>", more)
    columns = {"{}_cmd": log.inputs, "{}": log.outputs}
    content = begun(tmp_path, log, columns, text)[1]
    assert content["outputs"] == ["lift_position_2", "Tilt2_position"]


WRIST = ("wrist_pitch", "pitch", "wrist_roll")


@pytest.mark.parametrize(("channels", "right"), [
    ([c for j in WRIST for c in (Channel(j, j, True), Channel(f"{j}_position", j, False))],
     {j: f"{j}_cmd" for j in WRIST} | {f"{j}_position": j for j in WRIST}),
    # The names of the model's author, who called them as the columns of the log:
    ([Channel("elbow", "elbow", True), Channel("elbow_pos", "elbow", False)],
     {"elbow": "elbow", "elbow_pos": "elbow_pos", "": "elbow_ref"}),
    ([Channel("m1", "m1", True), Channel("enc1", "m1", False)],
     {"m1": "m1", "enc1": "encoder_1"}),
    ([Channel("motor", "elbow", True), Channel("angle", "elbow", False)],
     {"motor": "motor", "angle": "elbow_angle", "": "motor_ref"}),
    ([Channel("tau", "tau", True), Channel("q", "tau", False)], {"tau": "tau", "q": "q"}),
    # An actuator whose joint is measured by its rate alone:
    ([Channel("wheel", "wheel", True), Channel("spin", "wheel", False, is_rate=True)],
     {"wheel": "wheel", "spin": "wheel_vel"}),
    # An actuator whose name is a part of its joint's:
    ([Channel("knee", "knee_joint", True), Channel("knee_joint", "knee_joint", False)],
     {"knee": "knee_cmd", "knee_joint": "knee"}),
    # A tendon and its winch:
    ([Channel("rope", "", True), Channel("rope_length", "", False)],
     {"rope": "rope_cmd", "rope_length": "rope"}),
])  # fmt: skip
def test_names_go_where_they_belong(tmp_path, channels, right):
    names = sorted(right.values())
    data = np.random.default_rng(0).normal(size=(50, len(names) + 1))
    data[:, 0] = np.arange(50) / 50
    path = Path(tmp_path) / "log.csv"
    np.savetxt(path, data, delimiter=",", header=",".join(["time", *names]), comments="")
    found = {m.channel.name: m.column for m in match(channels, inspect_log(path))}
    assert found == {name: column for name, column in right.items() if name}
