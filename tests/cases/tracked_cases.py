"""Right logs of arms that a controller moves, of robots that differ from their model or not."""

import mujoco
import numpy as np
import pytest
from plain_logs import model_log

from identification import InputError, write_log
from identification.refusals.wiring import refuse_miswired
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log, robot_of

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
    return model_log(model, u, y)


def _mass(model, data):
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    return full


def robot(folder, xml, log, horizon=""):
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


def refused(own, log):
    """What is said of a log that is refused for its wiring."""
    with pytest.raises(InputError) as caught:
        refuse_miswired(own, log)
    return str(caught.value)
