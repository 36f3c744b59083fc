"""A log's columns that look like inputs, and that no actuator of the model takes, are told."""

import numpy as np
import pytest
from robot_cases import ARM, run
from touching_cases import simulated

from identification import fit, read_robot
from identification.robot.file.file import read_robot_file
from identification.robot.reading import doubtful
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

MOTORS = """<actuator><motor name="a" joint="shoulder"/><motor name="b" joint="elbow"/></actuator>
<sensor><jointpos name="shoulder" joint="shoulder"/><jointpos name="elbow" joint="elbow"/></sensor>
"""
ONE = '<actuator><motor name="a" joint="shoulder"/></actuator>'
TOML = 'model = "arm.xml"\nfree = ["joint/shoulder.damping"]\nhorizon = 0.3\n'


@pytest.fixture(scope="module")
def log():
    return simulated(ARM.format(damping=0.4, rest=MOTORS), samples=500)


@pytest.fixture
def told(tmp_path, log):
    """What is told of a log whose columns between time and the joints' positions have names."""

    def told(*names, rest="", more="", size=1.0, of_log=""):
        (tmp_path / "arm.xml").write_text(ARM.format(damping=0.3, rest=rest))
        (tmp_path / "robot.toml").write_text(TOML + more)
        (tmp_path / "log.toml").write_text(of_log)
        rows = np.column_stack([log.time, size * log.inputs[:, : len(names)], log.outputs])
        head = ",".join(("time", *names, "shoulder", "elbow"))
        np.savetxt(tmp_path / "log.csv", rows, "%.9g", ",", header=head, comments="")
        read = read_robot_log(read_robot_file(tmp_path / "robot.toml"), tmp_path / "log.csv")
        return " ".join(read.remarks).replace(f"{tmp_path}/", "")

    return told


def test_columns_in_the_order_of_the_joints_are_told_with_their_lines(told):
    assert told("torque_1 [Nm]", "torque_2 [Nm]") == (
        "torque_1 [Nm], torque_2 [Nm] of log 'log' look like inputs that no actuator of arm.xml"
        " takes. Nothing reads them, and what they did to the robot is taken for something else:"
        ' write shoulder_torque = "torque_1 [Nm]" and elbow_torque = "torque_2 [Nm]" (a line each)'
        " under [columns] in robot.toml, which gives each joint a motor of gear 1; or name them"
        " under ignore in log.toml if they drive nothing."
    )


@pytest.mark.parametrize("name", [
    "tau", "u", "effort", "motorTorque", "pwm", "force [N]", "i [A]", "voltage", "x [mN m]",
    "joint_states.effort", "motor_state.tau", "torque [kgcm]",
])  # fmt: skip
def test_one_column_of_several_joints_is_told_with_an_example(told, name):
    said = told(name)
    assert f"{name} of log 'log' looks like an input that no actuator of arm.xml takes" in said
    assert f'write such as shoulder_torque = "{name}" under [columns] in robot.toml' in said
    assert ("gear[0]" in said) == (name in ("i [A]", "voltage"))


def test_a_column_belongs_to_the_joint_whose_words_it_has(told):
    assert 'write elbow_torque = "tau of elbow" under [columns]' in told("tau of elbow")


def test_a_joint_gets_one_line_where_it_has_several_columns(told):
    said = told("elbow torque", "elbow current")
    assert 'write such as elbow_torque = "elbow torque" under [columns]' in said
    said = told("elbow torque", "elbow command")
    assert 'elbow_torque = "elbow torque" under [columns]' in said
    assert "a motor of gear 1; or add <position" in said


@pytest.mark.parametrize("name", ["target_elbow_pos", "elbow.command"])
def test_a_command_asks_for_a_servo(told, name):
    said = told(name)
    assert 'add <position name="elbow_command" joint="elbow" kp="1" kv="0.1"/>' in said
    assert "motor of gear 1" not in said


@pytest.mark.parametrize("name", [
    "temperature", "current_position", "battery_voltage [V]", "torque_enabled", "pot [V]",
    "velocity [rad/s]", "i", "control_mode",
])  # fmt: skip
def test_what_is_no_input_is_not_told(told, name):
    assert not told(name)


def test_a_column_that_is_zero_that_is_ignored_or_that_is_read_is_not_told(told):
    assert not told("tau", "u", size=0.0)
    assert not told("tau", "u", of_log='ignore = ["tau", "u"]\n')
    mapped = '[columns]\nshoulder_torque = "tau_1"\nelbow_torque = "tau_2"\n'
    assert not told("tau_1", "tau_2", more=mapped)
    sensor = '<sensor><jointpos name="q" joint="shoulder"/></sensor>'
    assert not told("torque", rest=sensor, more='[columns]\nq = "torque"\n')


def test_beside_an_actuator_only_that_of_a_joint_without_one_is_told(told):
    assert not told("a", "effort", rest=ONE)
    assert not told("a", "shoulder_effort", rest=ONE)
    assert 'write elbow_torque = "elbow effort" under' in told("a", "elbow effort", rest=ONE)


def test_it_stands_beside_the_result_and_its_lines_mend_it(told, tmp_path, capsys):
    told("torque_1", "torque_2")
    paths = tmp_path / "robot.toml", tmp_path / "log.csv"
    robot = read_robot(*paths)
    assert any("look like inputs" in sentence for sentence in doubtful(robot))
    said = run(capsys, "fit", *paths)
    assert any("look like inputs" in remark for remark in said["remarks"])
    told("torque_1", "torque_2",
         more='[columns]\nshoulder_torque = "torque_1"\nelbow_torque = "torque_2"\n')  # fmt: skip
    assert fit(read_robot(*paths)).values["joint/shoulder.damping"] == pytest.approx(0.4, rel=0.02)
