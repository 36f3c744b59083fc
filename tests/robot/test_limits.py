"""A joint that a log has far outside the model's limits is told before anything is simulated."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from identification import read_robot
from identification.commands.cli import main
from identification.errors import InputError
from identification.refusals.limits import limit_sentence

MODEL = """<mujoco><compiler {angle}/><worldbody><body>
  <joint name="swing" axis="0 1 0" damping="0.05" limited="{limited}" range="-2.5 2.5"/>
  <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.4" mass="0.5" contype="0" conaffinity="0"/>
  </body></worldbody><actuator><motor name="torque" joint="swing"/></actuator>
  <sensor><jointpos name="angle" joint="swing"/></sensor></mujoco>"""
RADIAN = 'angle="radian"'


def said(most, angle="", limited="true"):
    """The sentence on a joint that swings between -most and most [rad]."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(angle=angle, limited=limited))
    swing = {"swing": most * np.sin(np.linspace(0, 20, 400))}
    return limit_sentence(model, not angle, swing, Path("arm.xml"))


def test_a_range_in_radians_that_is_read_in_degrees_is_told_with_its_cure():
    assert RADIAN in said(1.2)
    assert not said(1.2, RADIAN)
    assert not said(1.2, limited="false")


@pytest.mark.parametrize("most", [2.5, 2.6, 4.0])
def test_what_a_soft_limit_lets_through_is_a_right_log(most):
    assert not said(most, RADIAN)


def test_a_log_in_degrees_is_left_to_the_checks_of_units():
    assert not said(np.rad2deg(2.0), RADIAN)
    told = said(12.0, RADIAN)
    assert "range" in told
    assert RADIAN not in told


def test_a_fit_refuses_it_and_the_file_to_begin_with_says_it(tmp_path, capsys):
    (tmp_path / "arm.xml").write_text(MODEL.format(angle="", limited="true"))
    time = np.arange(400) / 100
    rows = np.stack([time, np.sin(3 * time), 1.2 * np.sin(3 * time - 0.5)], axis=1)
    log = tmp_path / "log.csv"
    np.savetxt(log, rows, delimiter=",", header="time,torque,angle", comments="")
    robot = tmp_path / "robot.toml"
    assert main(["new", str(tmp_path / "arm.xml"), str(log), "--robot", str(robot)]) == 0
    assert RADIAN in capsys.readouterr().out
    assert "NEEDED: joint swing" in robot.read_text()
    with pytest.raises(InputError, match=RADIAN):
        read_robot(robot, log)
    assert read_robot(robot, log, trust=["limits"]).log.name == "log"
