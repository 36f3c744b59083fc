"""The gains of servos have the unit of a spring and of a damper at the place where they act."""

import mujoco
import pytest
from test_servo_robot import LINK

from identification import InputError, read_robot, write_log
from identification.robot.model_units import unit_of

ROBOT = """<mujoco><worldbody><site name="wall" pos="0 0 2"/><body name="cart">
<joint name="x" type="slide" axis="1 0 0"/><geom size="0.1" mass="1"/><site name="hook"/>
<body name="arm"><joint name="q" axis="0 1 0"/><geom size="0.1" mass="1" pos="0 0 1"/></body>
</body></worldbody>
<tendon><spatial name="rope"><site site="wall"/><site site="hook"/></spatial>
<fixed name="both"><joint joint="x" coef="1"/><joint joint="q" coef="2"/></fixed></tendon>
<actuator><position name="push" joint="x" kp="9" kv="2"/><position name="turn" joint="q" kp="5"/>
<velocity name="drive" joint="q" kv="3"/><position name="pull" tendon="rope" kp="4"/>
<position name="mixed" tendon="both" kp="4"/><position name="pinion" joint="q" gear="20" kp="4"/>
</actuator></mujoco>"""


@pytest.mark.parametrize(
    ("path", "unit"),
    [("push.kp", "N/m"), ("push.kv", "N s/m"), ("turn.kp", "N m/rad"), ("turn.kv", "N m s/rad"),
     ("drive.kv", "N m s/rad"), ("pull.kp", "N/m"), ("mixed.kp", ""), ("pinion.kp", ""),
     ("*r*.kv", "N m s/rad"), ("p*.kp", "")],
)  # fmt: skip
def test_a_gain_has_the_unit_of_its_place(path, unit):
    model = mujoco.MjModel.from_xml_string(ROBOT)
    assert unit_of(model, f"actuator/{path}") == unit


def test_a_free_gain_is_printed_with_its_unit_and_read_in_no_other(tmp_path):
    from touching_cases import simulated

    xml, toml = LINK.format(9.0, 0.5, 6.0), tmp_path / "link.toml"
    write_log(simulated(xml, samples=60, noise=1e-4), tmp_path / "log.csv")
    (tmp_path / "link.xml").write_text(xml)
    start = 'trust = ["steps"]\nmodel = "link.xml"\nfree = ["{}"]\n'
    toml.write_text(start.format("actuator/s1.kp"))
    robot = read_robot(toml, tmp_path / "log.csv")
    assert robot.plant.parameters["actuator/s1.kp"].unit == "N m/rad"
    table = '[parameters.k]\npath = "actuator/s1.kp"\nunit = "N/m"\n'
    toml.write_text(start.format("k") + table)
    with pytest.raises(InputError, match="N m/rad"):
        read_robot(toml, tmp_path / "log.csv")
