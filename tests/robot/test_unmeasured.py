"""A joint that moves what is measured, and that nothing measures and nothing holds, is refused."""

import mujoco
import pytest
from touching_cases import make_robot, simulated

from identification import InputError, read_robot
from identification.refusals.unmeasured import refuse_unmeasured

pytestmark = pytest.mark.usefixtures("few_effects")

LEG = """<mujoco>
<option timestep="0.002" integrator="RK4"/>
<worldbody>
<body name="trunk" pos="0 0 2">
{joint}
<geom type="box" size="0.2 0.1 0.1" mass="4" contype="0" conaffinity="0"/>
<body name="thigh">
<joint name="hip" axis="0 1 0" damping="0.5"/>
<inertial pos="0 0 -0.2" mass="0.8" diaginertia="0.01 0.01 0.001"/>
</body></body>
{more}
</worldbody>
<equality>{equality}</equality>
<actuator><motor name="u" joint="hip" gear="2"/></actuator>
<sensor><jointpos name="hip" joint="hip"/></sensor>
</mujoco>"""
FREE, BALL = "<freejoint/>", '<joint name="neck" type="ball"/>'
RAIL = '<joint name="rise" type="slide" axis="0 0.2 1"/>'
WELD = '<weld body1="{}" body2="trunk"/>'


def leg(joint="", more="", equality=""):
    return LEG.format(joint=joint, more=more, equality=equality)


@pytest.fixture(scope="module")
def log():
    return simulated(leg())


def read(folder, xml, log, more="horizon = 0.3\n", **options):
    return read_robot(make_robot(folder, xml, log, "hip", more), folder / "log.csv", **options)


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        ('<joint name="root" type="free"/>', "has a free joint 'root' of body trunk"),
        (BALL, "delete the ball joint in line 5 of robot.xml; write hinges whose angles the log"),
        (RAIL, "delete the slide joint in line 5 of robot.xml; add a jointpos sensor and its col"),
    ],
)
def test_each_kind_is_told_with_its_cure(tmp_path, log, joint, said):
    with pytest.raises(InputError) as caught:
        read(tmp_path, leg(joint), log, more="")
    assert said in str(caught.value)


def test_a_user_may_know_better(tmp_path, log):
    with pytest.raises(InputError, match=r'write trust = \["joints"\] into .*robot.toml if it tru'):
        read(tmp_path, leg(FREE), log)
    trust = ["joints", "wiring", "units"]
    assert read(tmp_path, leg(FREE), log, trust=trust).plant.model.nv == 7


def test_a_base_that_an_equality_welds_to_the_world_is_right(tmp_path, log):
    still = '<body name="bench"><geom size="0.1" contype="0"/></body>'
    held = leg(FREE, still, WELD.format("bench"))
    assert read(tmp_path, held, log, trust=["wiring"]).plant.model.nv == 7
    off = held.replace("<weld ", '<weld active="false" ')
    with pytest.raises(InputError, match="has a free joint of body trunk"):
        read(tmp_path, off, log)


@pytest.mark.parametrize(
    ("joint", "more"),
    [(RAIL.replace("0 0.2 1", "1 0 0"), ""), (RAIL.replace("/>", ' range="0 0.01"/>'), "")],
)
def test_a_slide_that_something_holds_may_be_unmeasured(tmp_path, log, joint, more):
    file = read(tmp_path, leg(), log).file
    xml = leg(joint).replace("<actuator>", f"<actuator>{more}")
    refuse_unmeasured(file, mujoco.MjModel.from_xml_string(xml), log)
    with pytest.raises(InputError, match="has a slide joint 'rise'"):
        refuse_unmeasured(file, mujoco.MjModel.from_xml_string(leg(RAIL)), log)


def test_what_lies_beside_the_robot_may_be_free(tmp_path, log):
    cube = '<body name="cube" pos="3 0 0"><freejoint/><geom size="0.1"/></body>'
    assert read(tmp_path, leg("", cube), log).plant.model.nv == 7
    tied = leg("", cube, '<connect body1="cube" body2="thigh" anchor="0 0 0"/>')
    with pytest.raises(InputError, match="has a free joint of body cube"):
        read(tmp_path, tied, log)
    rope = leg("", cube.replace("<geom", '<site name="a"/><geom')).replace(
        "<actuator>",
        '<tendon><spatial stiffness="9"><site site="a"/><site site="b"/></spatial></tendon>'
        "<actuator>",
    )
    rope = rope.replace('<joint name="hip"', '<site name="b" pos="0 0 -0.4"/><joint name="hip"')
    with pytest.raises(InputError, match="has a free joint of body cube"):
        read(tmp_path, rope, log)
