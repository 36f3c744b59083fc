"""Lengths of tendons that a log measures tell the joints, and tendons drive what they pull."""

import mujoco
import numpy as np
import pytest
from touching_cases import simulated

from identification import fit, read_robot
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

CRANE = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<site name="left" pos="-1 0 2"/><site name="right" pos="1 0 2"/>
<body name="load" pos="0.1 0 1"><joint name="x" type="slide" axis="1 0 0" damping="{damping}"/>
<joint name="z" type="slide" axis="0 0 1" damping="6"/>
<geom type="sphere" size="0.1" mass="{mass}" contype="0" conaffinity="0"/><site name="hook"/></body>
</worldbody>
<tendon><spatial name="a"><site site="left"/><site site="hook"/></spatial>
<spatial name="b"><site site="right"/><site site="hook"/></spatial></tendon>
<actuator><position name="winch_a" tendon="a" kp="600" kv="60"/>
<position name="winch_b" tendon="b" kp="600" kv="60"/></actuator>
<sensor><tendonpos name="length_a" tendon="a"/><tendonpos name="length_b" tendon="b"/>{more}
</sensor></mujoco>"""
FINGER = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<body name="near"><joint name="knuckle" axis="0 1 0" damping="0.02"/>
<inertial pos="0.02 0 0" mass="0.05" diaginertia="2e-5 2e-5 1e-5"/>
<body name="far" pos="0.05 0 0"><joint name="tip" axis="0 1 0" damping="0.01" stiffness="0.05"/>
<inertial pos="0.02 0 0" mass="{mass}" diaginertia="1e-5 1e-5 5e-6"/></body></body></worldbody>
<tendon><fixed name="cable"><joint joint="knuckle" coef="0.012"/><joint joint="tip" coef="0.009"/>
</fixed></tendon>
<equality><joint joint1="tip" joint2="knuckle" polycoef="0 0.8 0 0 0" solref="0.004 1"
  solimp="0.99 0.99 0.001"/></equality>
<actuator><motor name="pull" tendon="cable" gear="8"/></actuator>
<sensor><tendonpos name="cable" tendon="cable"/></sensor></mujoco>"""
ROBOT = """model = "robot.xml"
outputs = ["length_a", "length_b"]
free = ["body/load.mass", "joint/x.damping"]
horizon = 0.3
{more}"""
TRUTH = {"mass": 14.0, "damping": 9.0}


def crane(**numbers):
    return CRANE.format(**{"mass": 10, "damping": 6, "more": "", **numbers})


def recorded(xml, offset=0.0, samples=500, noise=1e-4, size=0.2):
    """Columns of lengths and of inputs that hold the robot about its place and move it."""
    model = mujoco.MjModel.from_xml_string(xml)
    data, rng = mujoco.MjData(model), np.random.default_rng(1)
    mujoco.mj_forward(model, data)
    first = data.ten_length.copy() * (model.nu == 2)
    u = first + size * np.repeat(rng.uniform(-1, 1, (samples // 25, model.nu)), 25, axis=0)
    y, q = np.zeros((samples, model.nsensordata)), np.zeros((samples, model.nq))
    for k in range(samples):
        mujoco.mj_forward(model, data)
        y[k], q[k], data.ctrl[:] = data.sensordata, data.qpos, u[k]
        mujoco.mj_step(model, data, 5)
    return u, y + offset + noise * rng.standard_normal(y.shape), q


def write(folder, xml, names, table, toml):
    (folder / "robot.xml").write_text(xml)
    (folder / "robot.toml").write_text(toml)
    rows = np.column_stack([0.01 * np.arange(len(table)), table])
    header = ",".join(("time", *names))
    np.savetxt(folder / "log.csv", rows, "%.9g", ",", header=header, comments="")
    return folder / "robot.toml", folder / "log.csv"


NAMES = ("winch_a", "winch_b", "length_a", "length_b")


def test_the_joints_are_those_with_which_the_lengths_were_made(tmp_path):
    u, y, q = recorded(crane(**TRUTH), noise=0.0)
    path, log = write(tmp_path, crane(), NAMES, np.hstack([u, y]), ROBOT.format(more=""))
    read = read_robot_log(read_robot_file(path), log)
    assert read.output_names == ("x", "z")
    assert read.outputs == pytest.approx(q, abs=1e-7)


def test_a_load_on_two_measured_tendons_is_fitted(tmp_path):
    u, y, _ = recorded(crane(**TRUTH))
    found = fit(read_robot(
        *write(tmp_path, crane(), NAMES, np.hstack([u, y]), ROBOT.format(more=""))
    ))  # fmt: skip
    for name, truth in (("body/load.mass", 14.0), ("joint/x.damping", 9.0)):
        assert abs(found.values[name] - truth) < 4 * found.std[name]
        assert found.std[name] < 0.05 * truth


def test_a_tendon_and_an_equality_tell_both_joints_of_a_finger(tmp_path):
    u, y, q = recorded(FINGER.format(mass=0.03), noise=0.0, size=0.4)
    toml = 'model = "robot.xml"\noutputs = ["cable"]\nfree = ["body/far.mass"]\nhorizon = 0.2\n'
    toml += '[columns]\ncable = "y"\n'
    paths = write(tmp_path, FINGER.format(mass=0.03), ("pull", "y"), np.hstack([u, y]), toml)
    read = read_robot_log(read_robot_file(paths[0]), paths[1])
    assert read.output_names == ("knuckle", "tip")
    # An equality of MuJoCo is soft: the pose found is that which holds it.
    assert read.outputs == pytest.approx(q, abs=0.03 * np.ptp(q))
    assert read.outputs[:, 1] == pytest.approx(0.8 * read.outputs[:, 0], abs=1e-8)


# An encoder at the base measures the angle of the far link, the sum of both joints, over a belt.
BELT = FINGER.replace(FINGER[FINGER.index("<equality>") : FINGER.index("<actuator>")], "").replace(
    "<sensor>", '<sensor><jointpos name="near" joint="knuckle"/><jointpos name="tip" joint="tip"/>'
)
NEAR = (BELT.format(mass=0.03), ("pull", "near", "tip", "cable"), ["near", "cable"])
ROPE = (
    crane(more='<jointpos name="x" joint="x"/><jointpos name="z" joint="z"/>'),
    (*NAMES, "x", "z"), ["length_b", "x"],
)  # fmt: skip


@pytest.mark.parametrize(("xml", "names", "outputs"), [NEAR, ROPE])
def test_a_joint_and_a_length_tell_the_other_joint(tmp_path, refusal, xml, names, outputs):
    u, y, q = recorded(xml, noise=0.0)
    toml = 'model = "robot.xml"\nfree = ["joint/*.damping"]\nhorizon = 0.2\noutputs = '
    paths = write(tmp_path, xml, names, np.hstack([u, y]), toml + str(outputs).replace("'", '"'))
    read = read_robot_log(read_robot_file(paths[0]), paths[1])
    assert np.ptp(q, axis=0).min() > 0.01
    assert {*read.output_names} in ({"near", "tip"}, {"x", "z"})
    order = np.argsort(read.output_names)
    assert read.outputs[:, order] == pytest.approx(q, abs=1e-7)
    every = [n for n in names if n in (*outputs, *read.output_names)]
    paths = write(tmp_path, xml, names, np.hstack([u, y]), toml + str(every).replace("'", '"'))
    text = refusal(read_robot_log, read_robot_file(paths[0]), paths[1])
    assert "one of these has nothing to tell; leave it out of outputs" in text


@pytest.mark.parametrize(
    ("outputs", "more", "offset", "said"),
    [
        (["length_a"], "", 0.0, "length_a tell 1 of the 2 ways to move of x, z"),
        (["length_a", "length_b"], "", -2.0, "no pose of the model has the lengths of log 'log'"),
        (["length_a", "length_b"], '"site/left.pos[0]", ', 0.0, "which moves where tendons run"),
    ],
)
def test_lengths_that_do_not_tell_the_joints_are_refused(
    tmp_path, refusal, outputs, more, offset, said
):
    u, y, _ = recorded(crane(), offset)
    toml = ROBOT.format(more="").replace('["length_a", "length_b"]', str(outputs).replace("'", '"'))
    toml = toml.replace("free = [", f"free = [{more}")
    paths = write(tmp_path, crane(), NAMES, np.hstack([u, y]), toml)
    assert said in refusal(read_robot, *paths)


CONNECTED = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<body name="crank"><joint name="crank" axis="0 1 0" damping="0.05"/>
<inertial pos="0 0 0.05" mass="0.3" diaginertia="4e-4 4e-4 5e-5"/>
<body name="rod" pos="0 0 0.1"><joint name="rod" axis="0 1 0"/>
<inertial pos="0.15 0 0" mass="0.4" diaginertia="5e-5 3e-3 3e-3"/></body></body>
<body name="rocker" pos="0.3 0 -0.1"><joint name="rocker" axis="0 1 0" damping="{damping}"/>
<inertial pos="0 0 0.1" mass="0.4" diaginertia="2e-3 2e-3 1e-4"/></body></worldbody>
<equality>{equality}</equality>
<actuator><motor name="u" joint="crank"/></actuator>
<sensor><jointpos name="crank" joint="crank"/><jointpos name="rod" joint="rod"/>
<jointpos name="rocker" joint="rocker"/></sensor></mujoco>"""


@pytest.mark.parametrize(
    "equality",
    [
        '<connect body1="rod" body2="rocker" anchor="0.3 0 0" solref="0.01 1"/>',
        '<joint joint1="rocker" joint2="crank" polycoef="0 -0.7 0 0 0" solref="0.01 1"/>',
    ],
)
def test_a_damping_beyond_an_equality_is_found(tmp_path, equality):
    log = simulated(CONNECTED.format(damping=0.3, equality=equality), samples=250)
    toml = 'model = "robot.xml"\nfree = ["joint/rocker.damping"]\nhorizon = 0.2\n'
    paths = write(
        tmp_path, CONNECTED.format(damping=0.1, equality=equality),
        (*log.input_names, *log.output_names), np.hstack([log.inputs, log.outputs]), toml,
    )  # fmt: skip
    found = fit(read_robot(*paths))
    assert found.values["joint/rocker.damping"] == pytest.approx(0.3, rel=0.05)
