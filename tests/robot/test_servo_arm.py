"""The worked example of an arm of servos: its recordings, and what a fit recovers of them."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from identification import fit, inspect_log, read_robot
from identification.inspection.beginning import write_beginning
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

FOLDER = Path(__file__).parents[2] / "examples" / "servo_arm"
spec = importlib.util.spec_from_file_location("servo_arm_record", FOLDER / "record.py")
script = importlib.util.module_from_spec(spec)
spec.loader.exec_module(script)
ROBOT = read_robot_file(FOLDER / "servo_arm.toml")


def test_the_recordings_are_those_of_the_script(tmp_path):
    commands, angles = script.record(1)
    log = read_robot_log(ROBOT, FOLDER / "first.mcap")
    assert log.inputs.tobytes() == commands.tobytes()
    assert log.outputs == pytest.approx(angles, abs=2 * np.pi / script.COUNTS)
    script.write(tmp_path, "again", 1)
    again = read_robot_log(ROBOT, tmp_path / "again.mcap")
    assert again.inputs.tobytes() == commands.tobytes()
    assert again.outputs.tobytes() == angles.tobytes()


def test_the_robot_s_file_is_the_one_that_is_written_to_begin_with(tmp_path):
    found = inspect_log(FOLDER / "first.mcap")
    begun = write_beginning(found, FOLDER / "arm.xml", tmp_path / "robot.toml")
    written = read_robot_file(begun.path)
    assert not begun.needs
    assert written.columns == ROBOT.columns
    assert written.outputs == ROBOT.outputs
    assert written.horizon == ROBOT.horizon
    assert all(answer.is_setpoint for answer in found.answers)


def test_gains_and_damping_are_recovered_from_the_recording():
    log = read_robot_log(ROBOT, FOLDER / "first.mcap").between(0.0, 15.0)
    values = fit(read_robot(FOLDER / "servo_arm.toml", log)).values
    for k, joint in enumerate(script.JOINTS):
        # The encoder's steps and those of the simulation err by one or two per cent.
        assert values[f"actuator/{joint}_servo.kp"] == pytest.approx(script.KP[k], rel=0.05)
        assert values[f"actuator/{joint}_servo.kv"] == pytest.approx(script.KV[k], rel=0.05)
        assert values[f"joint/{joint}.damping"] == pytest.approx(script.DAMPING[k], rel=0.05)
