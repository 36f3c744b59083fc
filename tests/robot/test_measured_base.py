"""A free joint whose pose a log measures is fitted like any other robot."""

import mujoco
import numpy as np
import pytest

from identification import fit, read_robot
from identification.logs.poses import Pose, angles, with_angles
from identification.logs.table import Table
from identification.robot.file.file import RobotFile, read_robot_file
from identification.robot.file.measured_base import with_measured_base
from identification.robot.results.write import write_robot
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

BUOY = """<mujoco>
<compiler angle="{angle}"/>
<option timestep="0.002" integrator="RK4" viscosity="{viscosity}" density="1"/>
<worldbody>
<site name="ceiling" pos="0 0 2.5"/>
<body name="buoy" pos="0.1 -0.2 1" quat="0.98 0.1 -0.05 0.15">
<joint name="base" type="free"/>
<geom type="box" size="0.2 0.15 0.1" mass="1" contype="0" conaffinity="0"/>
<site name="hook" pos="0.05 0 0.1"/><site name="marker" pos="0.1 0.02 0.12" euler="0.2 0 0.4"/>
<site name="jet_1" pos="0.2 0 0" euler="0 0.5 0"/><site name="jet_2" pos="0 0.15 -0.1"/>
<body pos="0 0 -0.1"><joint name="bob" axis="0 1 0" damping="0.02"/>
<inertial pos="0 0 -0.2" mass="0.3" diaginertia="0.001 0.001 0.0002"/></body>
</body>
</worldbody>
<tendon><spatial name="cord" springlength="0.6" stiffness="25" damping="0.4">
<site site="ceiling"/><site site="hook"/></spatial></tendon>
<actuator><motor name="u_1" site="jet_1" gear="0 0 1 0 0 0.05"/>
<motor name="u_2" site="jet_2" gear="1 1 0 0 0 0"/></actuator>
<sensor><jointpos name="bob" joint="bob"/>
<framepos name="place" objtype="site" objname="marker"/>
<framequat name="turn" objtype="site" objname="marker"/>
<framepos name="centre" objtype="body" objname="buoy"/></sensor>
</mujoco>"""
AS_DRAWN = {"angle": "radian", "viscosity": 0.3}
COLUMNS = ("x", "y", "z", "qw", "qx", "qy", "qz")
ROBOT = """model = "buoy.xml"
free = ["body/buoy.mass", "joint/bob.damping"]
horizon = 0.3
{more}
[columns]
{columns}
"""
OF_JOINT = 'base = ["x", "y", "z", "qw", "qx", "qy", "qz"]'


def file(folder, columns=OF_JOINT, more="", **numbers):
    (folder / "buoy.xml").write_text(BUOY.format(**{**AS_DRAWN, **numbers}))
    (folder / "robot.toml").write_text(ROBOT.format(columns=columns, more=more))
    return folder / "robot.toml"


def record(folder, name="log.csv", marker=False, seed=0, samples=500, noise=2e-4, flips=True):
    """A log of the buoy with 1.3 kg and more friction, simulated with its free joint."""
    model = mujoco.MjModel.from_xml_string(BUOY.format(**AS_DRAWN))
    model.body_mass[model.body("buoy").id] = 1.3  # and its inertia stays
    mujoco.mj_setConst(model, mujoco.MjData(model))
    model.dof_damping[model.joint("bob").dofadr[0]] = 0.03
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    u = np.repeat(rng.uniform(-2, 2, (samples // 20, 2)), 20, axis=0)
    rows = np.zeros((samples, 11))
    place = model.sensor("place").adr[0]
    for k in range(samples):
        mujoco.mj_forward(model, data)
        pose = data.sensordata[place : place + 7] if marker else data.qpos[:7]
        pose = pose + noise * rng.standard_normal(7)
        pose[3:] *= rng.choice([-1, 1]) if flips else 1
        pose[3:] /= np.linalg.norm(pose[3:])
        rows[k] = 0.01 * k, *u[k], *pose, data.qpos[7] + noise * rng.standard_normal()
        data.ctrl[:] = u[k]
        mujoco.mj_step(model, data, 5)
    header = ",".join(("time", "u_1", "u_2", *COLUMNS, "bob", "bob_2"))
    np.savetxt(
        folder / name, np.column_stack([rows, rows[:, -1]]), "%.9g", ",", header=header, comments=""
    )
    return folder / name


@pytest.mark.parametrize("angle", ["radian", "degree"])
def test_slides_and_hinges_move_as_the_free_joint_does(tmp_path, angle):
    path = file(tmp_path, angle=angle)
    spec = mujoco.MjSpec.from_string(BUOY.format(**{**AS_DRAWN, "angle": angle}))
    free, robot = (
        spec.copy().compile(),
        RobotFile(path=path, model=tmp_path / "buoy.xml", free=(), poses={"buoy": COLUMNS}),
    )
    (said,) = with_measured_base(spec, robot)
    assert "base_x, base_y, base_z, base_yaw, base_pitch, base_roll" in said
    model = spec.compile()
    a, b = mujoco.MjData(free), mujoco.MjData(model)
    mujoco.mj_forward(model, b)
    mujoco.mj_forward(free, a)
    assert b.xpos == pytest.approx(a.xpos, abs=1e-12)
    assert b.xmat == pytest.approx(a.xmat, abs=1e-12)
    assert model.tendon_length0 == pytest.approx(free.tendon_length0, abs=1e-12)
    for k in range(500):
        a.ctrl[:] = b.ctrl[:] = 2 * np.sin((0.011 * k, 0.017 * k))
        mujoco.mj_step(free, a)
        mujoco.mj_step(model, b)
    assert np.linalg.norm(b.qpos[:3] - model.qpos0[:3]) > 0.1
    assert b.qpos[:3] == pytest.approx(a.qpos[:3], abs=1e-7)
    (turned,) = angles(a.qpos[None, 3:7])
    assert b.qpos[3:6] == pytest.approx(turned, abs=1e-5)  # steps of the two differ
    assert np.ptp(turned) > 0.2


def test_a_quaternion_and_its_negative_are_one_rotation():
    rng = np.random.default_rng(0)
    rows = np.zeros((300, 7))
    turns = np.cumsum(rng.normal(0.03, 0.02, 300))
    rows[:, 3], rows[:, 6] = np.cos(turns / 2), np.sin(turns / 2)
    names = ("px", "py", "pz", "w", "x", "y", "z")
    pose = Pose("base", names)
    even = with_angles(Table("log", names, rows, str), [pose])
    flipped = rows.copy()
    flipped[:, 3:] *= rng.choice([-1, 1], (300, 1))
    again = with_angles(Table("log", names, flipped, str), [pose])
    assert (again.data == even.data).all()
    assert even["base_yaw"] == pytest.approx(turns, abs=1e-12)  # on and on, beyond half a turn
    late = ("px", "py", "pz", "x", "y", "z", "w")  # as ROS writes them
    ros = np.column_stack([flipped[:, :3], flipped[:, 4:], flipped[:, 3]])
    assert (with_angles(Table("l", late, ros, str), [Pose("base", late)]).data == even.data).all()


def test_a_mass_and_a_damping_are_found_within_their_std(tmp_path):
    robot = read_robot(file(tmp_path), record(tmp_path))
    assert robot.log.output_names[1:] == tuple(
        f"base_{axis}" for axis in ("x", "y", "z", "yaw", "pitch", "roll")
    )
    found = fit(robot)
    for name, truth in (("body/buoy.mass", 1.3), ("joint/bob.damping", 0.03)):
        assert abs(found.values[name] - truth) < 3 * found.std[name]
        assert found.std[name] < 0.05 * truth


def test_sensors_of_a_frame_on_the_base_tell_its_pose(tmp_path):
    def read(*given, **how):
        return read_robot_log(read_robot_file(file(tmp_path, *given)), record(tmp_path, **how))

    columns = 'place = ["x", "y", "z"]\nturn = ["qw", "qx", "qy", "qz"]'
    other = read(noise=0.0)
    assert read(columns, marker=True, noise=0.0).outputs == pytest.approx(other.outputs, abs=1e-7)
    named = read(columns, 'outputs = ["place", "turn"]', marker=True, noise=0.0)
    assert named.output_names == other.output_names[1:]


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ('base = ["x", "y", "z"]', "columns.base in"),
        ('place = ["x", "y", "z"]', "has the sensor 'place' of 'base' alone"),
        ('bob = ["x", "y"]', "columns.bob in"),
        ('base = ["x", "y", "z", "qw", "qx", "qy", "bob_2"]', "have the norm"),
    ],
)
def test_what_is_no_pose_is_refused(tmp_path, refusal, columns, said):
    assert said in refusal(read_robot, file(tmp_path, columns), record(tmp_path))


def test_a_pitch_near_a_right_angle_is_refused(refusal):
    names = ("px", "py", "pz", "w", "x", "y", "z")
    row = np.array([[0, 0, 0, np.cos(0.7), 0, np.sin(0.7), 0]])
    table = Table("log", names, row, lambda k: f"row {k}")
    assert "pitch of 'base' is beyond 75" in refusal(with_angles, table, [Pose("base", names)])


def test_the_robot_that_is_written_measures_the_base_too(tmp_path):
    robot = read_robot(file(tmp_path), record(tmp_path, samples=300))
    again = write_robot(robot, {"body/buoy.mass": 1.2}, tmp_path / "again.toml", tmp_path)
    assert read_robot_log(read_robot_file(again), tmp_path / "log.csv").output_names == (
        robot.log.output_names
    )


@pytest.mark.parametrize(("unit", "size"), [("mm", 1e3), ("furlong", 1.0)])
def test_the_columns_of_a_pose_have_the_unit_of_their_headers(tmp_path, unit, size):
    path = record(tmp_path)
    plain = read_robot_log(read_robot_file(file(tmp_path)), path)
    head, rows = path.read_text().split("\n", 1)
    names = [f"{n} [{unit}]" if n in COLUMNS[:3] else n for n in head.split(",")]
    table = np.loadtxt(rows.splitlines(), delimiter=",")
    table[:, [n in COLUMNS[:3] for n in head.split(",")]] *= size
    np.savetxt(path, table, "%.12g", ",", header=",".join(names), comments="")
    listed = ", ".join(f'"{n} [{unit}]"' if n in COLUMNS[:3] else f'"{n}"' for n in COLUMNS)
    log = read_robot_log(read_robot_file(file(tmp_path, f"base = [{listed}]")), path)
    np.testing.assert_allclose(log.outputs, plain.outputs, atol=1e-6)
    assert ("is no known unit" in " ".join(log.remarks)) == (unit == "furlong")
