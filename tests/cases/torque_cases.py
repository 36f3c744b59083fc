"""Arms whose torques are compared: a planar one with its records in closed loop, and a tree."""

import mujoco
import numpy as np
from plain_logs import plain_log

from identification import read_robot

TREE = """
<mujoco>
  <option gravity="0.3 -1 -9.5"/>
  <worldbody>
    <body name="a" pos="0 0 0.2" euler="10 20 30">
      <joint name="turn" axis="0.2 0.1 1" armature="0.3" damping="0.2"/>
      <inertial pos="0.1 0.02 0.3" mass="2" fullinertia="0.03 0.02 0.04 0.001 0.002 0.003"/>
      <body name="b" pos="0.3 0 0.1" euler="40 0 10">
        <joint name="slip" type="slide" axis="1 0.3 0" stiffness="3" armature="0.1"/>
        <inertial pos="0 0.1 0.05" mass="1" fullinertia="0.01 0.02 0.015 0.001 0 0.002"/>
        <body name="welded" pos="0 0.1 0" euler="0 30 0">
          <inertial pos="0.02 0 0.1" mass="0.7" diaginertia="0.002 0.003 0.001"/>
        </body>
        <body name="c" pos="0 0.2 0">
          <joint name="bend" axis="0 1 0.4" pos="0 0.01 0"/>
          <inertial pos="0.05 0 0.1" mass="0.5" diaginertia="0.004 0.003 0.002"/>
        </body>
      </body>
      <body name="d" pos="0 -0.2 0">
        <joint name="swing" axis="1 0 0"/>
        <inertial pos="0 0 -0.1" mass="0.4" diaginertia="0.002 0.002 0.001"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
# A planar arm with geared joints: lengths 0.5 m, centres of mass on the links.
PLANAR = """
<mujoco><compiler angle="radian"/><option timestep="{step}" integrator="implicitfast"/><worldbody>
<body name="upper"><joint name="shoulder" axis="0 1 0" armature="0.8" damping="{d}"
 frictionloss="{f}"/><inertial pos="0 0 0.25" mass="4" diaginertia="0.09 0.09 0.01"/>
<body name="fore" pos="0 0 0.5"><joint name="elbow" axis="0 1 0" armature="0.3" damping="{d}"
 frictionloss="{f}" stiffness="{k}"/>
<inertial pos="0 0 0.2" mass="2" diaginertia="0.03 0.03 0.005"/>
<site name="tool" pos="0 0 0.5"/>{load}</body></body></worldbody>
<actuator><motor name="t1" joint="shoulder" gear="10"/><motor name="t2" joint="elbow" gear="5"/>
</actuator><sensor><jointpos name="q1" joint="shoulder"/><jointpos name="q2" joint="elbow"/>
</sensor></mujoco>
"""
LOAD = '<body name="load" pos="0 0 0.5"><inertial pos="0 0 0" mass="{}" diaginertia="{}"/></body>'
GEARS, STEP, EVERY = np.array([10.0, 5.0]), 0.001, 10
TOML = """
model = "arm.xml"
free = ["joint/elbow.armature", "body/fore.mass"]
horizon = 0.2
[parameters."joint/elbow.armature"]
known = 0.1
[parameters."body/fore.mass"]
known = 0.05
"""


def planar(load=0.0, d=2.0, f=1.0, step=STEP, k=0.0):
    more = LOAD.format(load, "1e-5 1e-5 1e-5") if load else ""
    return PLANAR.format(step=step, d=d, f=f, load=more, k=k)


def planar_record(
    seed, load=0.0, name="log", lasts=12.0, noise=2e-5, d=2.0, f=1.0, k=0.0, force=None
):
    """A record of the arm that follows five harmonics; its controller does not see the noise.

    A force of positions and rates acts at the elbow, where one is given.
    """
    model = mujoco.MjModel.from_xml_string(planar(load, d, f, k=k))
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    ω = 2 * np.pi * 0.15 * np.arange(1, 6)
    a, p = rng.uniform(0.05, 0.3, (2, 5)), rng.uniform(0, 2 * np.pi, (2, 5))
    data.qpos = (a * np.sin(p)).sum(axis=1)
    data.qvel = (a * ω * np.cos(p)).sum(axis=1)
    rows = []
    for n in range(int(lasts / STEP)):
        if n % EVERY == 0:
            phase = ω * n * STEP + p
            off = (a * np.sin(phase)).sum(axis=1) - data.qpos
            slow = (a * ω * np.cos(phase)).sum(axis=1) - data.qvel
            data.ctrl = (np.array([800.0, 300.0]) * off + np.array([60.0, 20.0]) * slow) / GEARS
            rows.append([n * STEP, *data.ctrl, *(data.qpos + noise * rng.standard_normal(2))])
        if force is not None:
            data.qfrc_applied[1] = force(data.qpos, data.qvel)
        mujoco.mj_step(model, data)
    table = np.array(rows)
    return plain_log(table[:, 1:3], table[:, 3:], "t1 t2", "q1 q2", time=table[:, 0], name=name)


def planar_robot(folder, *logs, toml=TOML, confirm=(), k=0.0):
    (folder / "arm.xml").write_text(planar(k=k))
    (folder / "arm.toml").write_text(toml)
    return read_robot(folder / "arm.toml", logs, confirm, ("wiring", "units", "steps"))
