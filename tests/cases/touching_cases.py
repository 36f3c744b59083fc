"""Robots whose geoms touch, on purpose or not, with logs that plain MuJoCo simulates."""

import mujoco
import numpy as np
from plain_logs import model_log

from identification import write_log

HEAD = '<mujoco><option timestep="0.002" integrator="implicitfast">{flag}</option>'
# An arm beside a column that is fixed to the world: the log was made without their contact.
PEDESTAL = (
    HEAD
    + """<worldbody><body name="pedestal" pos="0 0 1">
  <geom name="column" type="box" size="0.06 0.25 0.07" {geom}/>
  <body name="arm" pos="0.055 0.25 0"><joint name="q" axis="0 1 0" damping="0.4" armature="0.02"/>
  <inertial pos="0.02 0 -0.04" mass="0.9" diaginertia="0.002 0.002 0.002"/>
  <geom name="link" type="capsule" fromto="0.04 0 0 0.09 0 0" size="0.055" {geom}/>
  </body></body></worldbody>
  <contact>{contact}</contact>
  <actuator><position name="u" joint="q" kp="15" kv="1"/></actuator>
  <sensor><jointpos name="q" joint="q"/></sensor></mujoco>"""
)
# The same with a link that turns about the middle of its column: no contact force has a lever.
SHAFT = PEDESTAL.replace('pos="0.055 0.25 0"', 'pos="0 0 0"').replace(
    'fromto="0.04 0 0 0.09 0 0" size="0.055"', 'fromto="0 0 0 0 0.4 0" size="0.03"'
)
UNTOUCHED = {"flag": '<flag contact="disable"/>'}
# A wheel that its motor rolls over the ground, which it touches all the time.
WHEEL = (
    HEAD
    + """<worldbody><geom name="ground" type="plane" size="9 9 1"/>
  <body name="wheel" pos="0 0 0.1495"><joint name="x" type="slide" axis="1 0 0"/>
  <joint name="z" type="slide" axis="0 0 1"/><joint name="r" axis="0 1 0" damping="0.05"/>
  <geom name="tyre" type="cylinder" euler="90 0 0" size="0.15 0.03" mass="{mass}"
    friction="{friction}"/></body></worldbody>
  <actuator><motor name="u" joint="r" gear="1.2"/></actuator>
  <sensor><jointpos name="r" joint="r"/><jointpos name="x" joint="x"/></sensor></mujoco>"""
)
# A carriage that runs against a buffer at the end of its way.
BUFFER = (
    HEAD
    + """<worldbody><geom name="buffer" type="box" pos="0.5 0 0" size="0.1 1 1"/>
  <body name="carriage"><joint name="x" type="slide" axis="1 0 0" damping="4"/>
  <geom name="box" type="box" size="0.1 0.1 0.1" mass="{mass}"/></body></worldbody>
  <actuator><motor name="u" joint="x" gear="9"/></actuator>
  <sensor><jointpos name="x" joint="x"/></sensor></mujoco>"""
)
# A gripper that is closed all the time: nothing measures its fingers.
GRIPPER = (
    HEAD
    + """<worldbody><body name="arm"><joint name="q" axis="0 0 1" damping="0.3"/>
  <inertial pos="0.2 0 0" mass="{mass}" diaginertia="0.02 0.02 0.02"/>
  <body name="left" pos="0.5 0.049 0"><joint name="fl" type="slide" axis="0 1 0"/>
  <geom type="box" size="0.02 0.05 0.02" mass="0.05"/></body>
  <body name="right" pos="0.5 -0.049 0"><joint name="fr" type="slide" axis="0 -1 0"/>
  <geom type="box" size="0.02 0.05 0.02" mass="0.05"/></body></body></worldbody>
  <actuator><motor name="u" joint="q" gear="5"/></actuator>
  <sensor><jointpos name="q" joint="q"/></sensor></mujoco>"""
)
PLAIN = {"flag": "", "geom": "", "contact": "", "mass": 1.5, "friction": 0.8}


def simulated(xml, samples=600, seed=0, noise=2e-4):
    """A log of a model at 100 Hz under random steps of its inputs."""
    rng, model = np.random.default_rng(seed), mujoco.MjModel.from_xml_string(xml)
    data, steps = mujoco.MjData(model), round(0.01 / model.opt.timestep)
    u = np.repeat(rng.uniform(-1, 1, (samples // 25 + 1, model.nu)), 25, axis=0)[:samples]
    y = np.zeros((samples, model.nsensor))
    for k in range(samples):
        data.ctrl[:] = u[k]
        mujoco.mj_forward(model, data)
        y[k] = data.sensordata
        mujoco.mj_step(model, data, steps)
    return model_log(model, u, y + noise * rng.standard_normal(y.shape), name="log")


def make_robot(folder, xml, log, joint, more="horizon = 0.3\n"):
    """Write a robot whose damping is free, and its log; returns the path of the robot.

    The log was made with the model's own steps, whose error is then no matter.
    """
    (folder / "robot.xml").write_text(xml)
    (folder / "robot.toml").write_text(
        f'{more}trust = ["steps"]\nmodel = "robot.xml"\nfree = ["joint/{joint}.damping"]\n'
    )
    write_log(log, folder / "log.csv")
    return folder / "robot.toml"
