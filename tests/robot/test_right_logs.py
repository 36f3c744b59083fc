"""No right log is refused: not with a payload, gravity, friction or mass that the model lacks."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from identification import InputError, Log, write_log
from identification.robot.file import read_robot_file
from identification.robot.robot import read_robot_log, robot_of
from identification.robot.wiring import refuse_miswired

UR10E = Path(__file__).parents[3] / "shared" / "data" / "ur10e" / "ur10e.xml"
HEAD = '<mujoco><compiler autolimits="true"/><option timestep="0.0025" integrator="RK4"/>'
PENDULUM = (
    HEAD
    + """<worldbody><body><joint name="q1" axis="0 1 0" damping="0.05"/>
<inertial pos="0 0 -0.3" mass="1" diaginertia="0.01 0.01 0.005"/></body></worldbody>
<actuator><motor name="u1" joint="q1"/></actuator>
<sensor><jointpos name="q1" joint="q1"/></sensor></mujoco>"""
)
ARM = (
    HEAD
    + """<worldbody><body><joint name="q1" axis="0 1 0" damping="0.3"/>
<inertial pos="0 0 -0.2" mass="2" diaginertia="0.03 0.03 0.01"/>
<body pos="0 0 -0.4"><joint name="q2" axis="0 1 0" damping="0.1"/>
<inertial pos="0 0 -0.15" mass="1" diaginertia="0.01 0.01 0.005"/></body></body></worldbody>
<actuator><motor name="u1" joint="q1"/><motor name="u2" joint="q2"/></actuator>
<sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor></mujoco>"""
)
MOTION = {  # amplitude [rad], frequency [Hz] and middle of each joint
    PENDULUM: ((0.8, 0.5, 0.3),),
    ARM: ((0.6, 0.4, 0.5), (0.9, 0.7, -0.8)),
}


def payload(model, mass=1.0):
    last = model.nbody - 1
    model.body_mass[last] += mass
    model.body_ipos[last] *= 1.2
    model.body_inertia[last] += 0.01 * mass


def no_gravity(model):
    model.opt.gravity[:] = 0.0


def friction(model):
    model.dof_damping[:] *= 3.0
    model.dof_frictionloss[:] = 0.2


def heavy(model):
    model.body_mass[:] *= 2.0
    model.body_inertia[:] *= 2.0


def nothing(model):
    pass


def tracked(model, motion, seconds=6.0, seed=0):
    """A log of an arm that a controller holds to a motion: it knows nothing of the model."""
    rng, data = np.random.default_rng(seed), mujoco.MjData(model)
    a, f, middle = (np.array(x) for x in zip(*motion, strict=True))
    n, gear = round(100 * seconds), model.actuator_gear[:, 0]
    mujoco.mj_setConst(model, data)
    data.qpos[:] = middle
    mujoco.mj_forward(model, data)
    hold, size = np.zeros(model.nv), np.diag(_mass(model, data)).copy()
    u, y = np.zeros((n, model.nu)), np.zeros((n, model.nv))
    for k in range(n):
        t = 0.01 * k
        wanted = middle + a * np.sin(2 * np.pi * f * t) + 0.1 * a * np.sin(2 * np.pi * 2.3 * f * t)
        rate = (
            2 * np.pi * f * a * (np.cos(2 * np.pi * f * t) + 0.23 * np.cos(2 * np.pi * 2.3 * f * t))
        )
        y[k] = data.qpos
        hold += 0.01 * 2000 * size * (wanted - data.qpos)
        force = size * (400 * (wanted - data.qpos) + 30 * (rate - data.qvel)) + hold
        u[k] = data.ctrl[:] = force / gear
        mujoco.mj_step(model, data, 4)
    y += 2e-4 * rng.standard_normal(y.shape)
    return Log(time=0.01 * np.arange(n), inputs=u, outputs=y,
               input_names=[model.actuator(i).name for i in range(model.nu)],
               output_names=[model.sensor(i).name for i in range(model.nsensor)])  # fmt: skip


def _mass(model, data):
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    return full


def robot(folder, xml, log, horizon):
    """The robot of a model, and a log as it is read for it."""
    (folder / "robot.xml").write_text(xml)
    joint = mujoco.MjModel.from_xml_string(xml).joint(0).name
    (folder / "robot.toml").write_text(
        f'{horizon}\nmodel = "robot.xml"\nfree = ["joint/{joint}.damping"]\n'
    )
    write_log(log, folder / "log.csv")
    file = read_robot_file(folder / "robot.toml")
    read = read_robot_log(file, folder / "log.csv")
    return robot_of(file, read), read


@pytest.mark.parametrize(
    ("xml", "horizon"),
    [(PENDULUM, ""), (ARM, "horizon = 0.2")],
    ids=["pendulum", "arm"],
)
@pytest.mark.parametrize(
    ("world", "lacking"),
    [
    (payload, nothing),
    (nothing, no_gravity),
    (friction, nothing),
],
    ids=lambda f: f.__name__,
)  # fmt: skip
def test_a_right_log_is_not_refused(tmp_path, xml, horizon, world, lacking):
    spec = mujoco.MjSpec.from_string(xml)
    truth = spec.compile()
    world(truth)
    known = spec.compile()
    lacking(known)
    own, log = robot(tmp_path, xml, tracked(truth, MOTION[xml]), horizon)
    for field in ("body_mass", "body_inertia", "dof_damping", "dof_frictionloss"):
        getattr(own.plant.model, field)[:] = getattr(known, field)
    own.plant.model.opt.gravity[:] = known.opt.gravity
    refuse_miswired(own, log)


@pytest.mark.parametrize("xml", [PENDULUM, ARM], ids=["pendulum", "arm"])
def test_a_wrong_sign_is_refused_all_the_same(tmp_path, xml):
    log = tracked(mujoco.MjModel.from_xml_string(xml), MOTION[xml])
    outputs = log.outputs.copy()
    outputs[:, -1] *= -1
    wrong = replace(log, outputs=outputs)
    own, read = robot(tmp_path, xml, wrong, "")
    with pytest.raises(InputError, match=r'or write trust = \["wiring"\] into .*robot.toml'):
        refuse_miswired(own, read)
    refuse_miswired(replace(own, file=replace(own.file, trust=("wiring",))), read)


@pytest.mark.skipif(not UR10E.exists(), reason="no ur10e.xml in ../shared/data")
def test_an_arm_of_six_joints_that_holds_5_kg_is_not_refused(tmp_path):
    xml = UR10E.read_text()
    model = mujoco.MjModel.from_xml_string(xml)
    payload(model, 5.0)
    motion = [(0.4, 0.15, 0.0), (0.3, 0.2, -1.3), (0.4, 0.25, 0.8),
              (0.3, 0.3, -1.0), (0.05, 0.35, 0.3), (0.5, 0.4, 0.0)]  # fmt: skip
    refuse_miswired(*robot(tmp_path, xml, tracked(model, motion), "horizon = 0.2"))
