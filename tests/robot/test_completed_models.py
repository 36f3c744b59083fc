"""A URDF is completed for a log, and a step that divides no sampling time is chosen."""

from dataclasses import replace

import mujoco
import pytest
from joint_cases import SLIDER, run, slider, slider_log, steps
from plain_logs import noise, plain_log, stepped
from robot_cases import TOML
from touching_cases import simulated

from identification import fit, read_robot, write_log
from identification.robot.file.model_file import unit_of

pytestmark = pytest.mark.usefixtures("few_effects")
MESH = '<{0}><geometry><mesh filename="package://none/{1}.stl"/></geometry></{0}>'
URDF = f"""<?xml version="1.0"?><robot name="two">
<link name="base">{MESH.format("visual", "base")}</link>
<link name="upper"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/>
<inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
{MESH.format("visual", "upper")}{MESH.format("collision", "upper")}</link>
<link name="lower"><inertial><origin xyz="0 0 -0.1"/><mass value="0.5"/>
<inertia ixx="0.01" iyy="0.01" izz="0.005" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="tool"/>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/>
<axis xyz="0 1 0"/><dynamics damping="0.2"/></joint>
<joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
<origin xyz="0 0 -0.4"/><axis xyz="0 1 0"/><dynamics damping="0.1"/></joint>
<joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/></joint></robot>"""
SAME = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<body><joint name="shoulder" axis="0 1 0" damping="{0}"/>
<inertial pos="0 0 -0.2" mass="1" diaginertia="0.02 0.02 0.01"/>
<body pos="0 0 -0.4"><joint name="elbow" axis="0 1 0" damping="0.1"/>
<inertial pos="0 0 -0.1" mass="0.5" diaginertia="0.01 0.01 0.005"/></body></body></worldbody>
<actuator><motor name="shoulder" joint="shoulder"/><motor name="elbow" joint="elbow"/></actuator>
</mujoco>"""


@pytest.fixture
def arm(tmp_path):
    """The folder of a URDF and of a log of the same arm with more damping."""
    model = mujoco.MjModel.from_xml_string(SAME.format(0.3))
    u = 0.5 * steps(600, 2, hold=30)
    y = stepped(model, u) + noise(u.shape, 2e-4)
    log = plain_log(u, y, "shoulder_torque elbow_torque", "shoulder elbow")
    write_log(log, tmp_path / "log.csv")
    (tmp_path / "two.urdf").write_text(URDF)
    (tmp_path / "robot.toml").write_text(
        'model = "two.urdf"\nfree = ["joint/shoulder.damping"]\nhorizon = 0.3\n'
    )
    return tmp_path


def test_a_urdf_without_its_meshes_is_fitted_like_any_model(arm):
    robot = read_robot(arm / "robot.toml", arm / "log.csv")
    (said,) = robot.remarks
    assert said.startswith("two.urdf is a URDF: 3 visual and collision shapes were left out")
    assert "shoulder_torque, elbow_torque; the integrator is RK4." in said
    found = fit(robot)
    assert found.values["joint/shoulder.damping"] == pytest.approx(0.3, rel=0.02)


def test_links_that_move_without_a_mass_are_named(arm, refusal):
    lower = URDF[URDF.index('<inertial><origin xyz="0 0 -0.1"') : URDF.index('<link name="tool"')]
    text = URDF.replace(lower, "</link>\n")
    (arm / "two.urdf").write_text(text)
    said = refusal(read_robot, arm / "robot.toml", arm / "log.csv")
    assert "lower moves and has no <inertial> with a mass" in said
    (arm / "two.urdf").write_text(text.replace('<link name="tool"/>', '<link name="tool"><inertial>'
        '<mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        "</link>"))  # fmt: skip
    assert read_robot(arm / "robot.toml", arm / "log.csv", trust=["wiring", "units"])
    (arm / "two.urdf").write_text(URDF[:-3])
    assert "is no XML" in refusal(read_robot, arm / "robot.toml", arm / "log.csv")


def test_a_step_that_does_not_divide_the_sampling_time_is_replaced(tmp_path):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "robot.toml").write_text(TOML)
    u = steps(600)
    log = slider_log(u, run(slider(), slider_log(u)))
    log = replace(log, time=log.time * 0.0107 / 0.01, output_names=("x",), units={})
    write_log(log, tmp_path / "log.csv")
    robot = read_robot(tmp_path / "robot.toml", tmp_path / "log.csv")
    (said,) = robot.remarks
    assert "step of 0.002 s does not divide the sampling time of 0.0107 s" in said
    assert robot.plant.model.opt.timestep == pytest.approx(0.0107 / 6)


LINK = """<mujoco><option timestep="0.002" integrator="implicitfast"/>
  <worldbody><body name="upper"><joint name="q1" axis="0 1 0" damping="0.1" armature="0.02"/>
    <inertial pos="0 0 -0.1" mass="0.6" diaginertia="0.004 0.004 0.001"/>
    <body name="lower" pos="0 0 -0.25"><joint name="q2" axis="0 1 0" damping="0.05"/>
      <inertial pos="0 0 -0.1" mass="0.4" diaginertia="0.004 0.004 0.001"/></body></body>
  </worldbody>
  <actuator><position name="s1" joint="q1" kp="{0}" kv="{1}"/>
    <position name="s2" joint="q2" kp="{2}" kv="{1}"/></actuator>
  <sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor></mujoco>"""
TRUTH = (9.0, 0.5, 6.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("servos")
    write_log(simulated(LINK.format(*TRUTH), samples=400, noise=1e-4), path / "log.csv")
    (path / "link.xml").write_text(LINK.format(14.0, 0.5, 14.0))
    return path


def read(folder, text):
    path = folder / "link.toml"
    path.write_text(f'trust = ["steps"]\nmodel = "link.xml"\n{text}')
    return read_robot(path, folder / "log.csv")


def test_the_gains_of_servos_of_one_make_are_alike(folder):
    table = '[spread.kp]\nof = ["actuator/s1.kp", "actuator/s2.kp"]\nstd = 0.3\n'
    robot = read(folder, f'horizon = 0.3\nfree = ["actuator/s1.kv"]\n{table}')
    values = {"kp": 10.0, "kp@s1": -0.1, "kp@s2": -0.4}
    model = robot.plant.with_values(values).model
    assert model.actuator_gainprm[:, 0] == pytest.approx([9.0, 6.0])
    assert model.actuator_biasprm[:, 1] == pytest.approx([-9.0, -6.0])


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


@pytest.mark.parametrize(("path", "unit"), [
    ("push.kp", "N/m"), ("turn.kv", "N m s/rad"), ("mixed.kp", ""), ("p*.kp", ""),
])  # fmt: skip
def test_a_gain_has_the_unit_of_its_place(path, unit):
    model = mujoco.MjModel.from_xml_string(ROBOT)
    assert unit_of(model, f"actuator/{path}") == unit


@pytest.mark.parametrize("path", ["body/arm.ipos[2]", "body/arm.pos", "joint/q.pos[0]"])
def test_a_place_is_told_in_metres(path):
    assert unit_of(mujoco.MjModel.from_xml_string(ROBOT), path) == "m"
