"""An MJCF without sensors or actuators is completed for its log, and says so."""

import tomllib

import numpy as np
import pytest
from robot_cases import ARM, run
from touching_cases import simulated

from identification import fit, read_robot
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

MOTORS = """<actuator><motor name="{0}" joint="shoulder"/><motor name="{1}" joint="elbow"/>
</actuator>"""
SENSORS = """<sensor><jointpos name="shoulder" joint="shoulder"/>
<jointpos name="elbow" joint="elbow"/></sensor>"""
TORQUES = ("shoulder_torque", "elbow_torque")
TOML = """model = "arm.xml"
free = ["joint/shoulder.damping"]
horizon = 0.3
{more}"""


@pytest.fixture(scope="module")
def log():
    return simulated(ARM.format(damping=0.4, rest=MOTORS.format(*TORQUES) + SENSORS), samples=500)


def write(folder, log, rest="", more="", effort="{}_torque", position="{}"):
    """The files of an arm that lacks something, and of a log with other names of columns."""
    (folder / "arm.xml").write_text(ARM.format(damping=0.3, rest=rest))
    (folder / "robot.toml").write_text(TOML.format(more=more))
    joints = ("shoulder", "elbow")
    names = ("time", *(effort.format(j) for j in joints), *(position.format(j) for j in joints))
    table = np.column_stack([log.time, log.inputs, log.outputs])
    np.savetxt(folder / "log.csv", table, "%.9g", ",", header=",".join(names), comments="")
    return folder / "robot.toml", folder / "log.csv"


def test_sensors_are_added_and_told(tmp_path, log):
    robot = read_robot(*write(tmp_path, log, MOTORS.format(*TORQUES)))
    assert robot.log.output_names == ("shoulder", "elbow")
    assert robot.remarks[0] == (
        "arm.xml lacks and got sensors of joint positions, shoulder, elbow."
    )


def test_one_joint_that_has_no_sensor_gets_it_where_the_file_asks(tmp_path, log):
    rest = MOTORS.format(*TORQUES) + SENSORS.replace('<jointpos name="elbow" joint="elbow"/>', "")
    paths = write(tmp_path, log, rest)
    assert read_robot(*paths).log.output_names == ("shoulder",)
    write(tmp_path, log, rest, 'outputs = ["shoulder", "elbow"]')
    assert read_robot(*paths).log.output_names == ("shoulder", "elbow")


def test_motors_are_added_where_the_file_names_torques(tmp_path, log):
    columns = "[columns]\n" + "".join(f'{n} = "{n}"\n' for n in TORQUES)
    robot = read_robot(*write(tmp_path, log, more=columns))
    assert robot.log.input_names == TORQUES
    assert robot.remarks[0].endswith("and motors of gear 1, shoulder_torque, elbow_torque.")
    found = fit(robot)
    assert found.values["joint/shoulder.damping"] == pytest.approx(0.4, rel=0.02)


def test_torques_that_nothing_reads_are_no_free_swing(tmp_path, log, refusal):
    paths = write(tmp_path, log)
    said = refusal(read_robot, *paths)
    assert "has shoulder_torque, elbow_torque, and arm.xml has no actuator that takes them" in said
    assert 'write shoulder_torque = "shoulder_torque", elbow_torque = "elbow_torque" under' in said
    (tmp_path / "log.toml").write_text('ignore = ["shoulder_torque", "elbow_torque"]\n')
    assert read_robot_log(read_robot_file(paths[0]), paths[1]).inputs.shape == (500, 0)


@pytest.mark.parametrize("effort", ["joint_states.effort.{}", "{}_torque"])
def test_new_gives_motors_to_a_log_of_torques(tmp_path, log, capsys, monkeypatch, effort):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, log, effort=effort, position="joint_states.position.{}")
    said = run(capsys, "new", "arm.xml", "log.csv", "--robot", "new.toml")
    assert said["needs"] == []
    content = tomllib.loads((tmp_path / "new.toml").read_text())
    assert content["columns"]["elbow_torque"] == effort.format("elbow")
    found = fit(read_robot("new.toml", "log.csv"))
    assert found.values["joint/shoulder.damping"] == pytest.approx(0.4, rel=0.02)
