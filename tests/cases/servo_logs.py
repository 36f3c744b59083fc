"""Logs of arms on position servos, whose numbers differ from those of their models."""

import mujoco
import numpy as np
from plain_logs import model_log, noise, stepped

HEAD = '<mujoco><compiler angle="radian"/><option timestep="0.002" integrator="RK4"/>'
# A shoulder and an elbow that lift their links; the numbers of a robot stand in the place of {}.
LIFTING = (
    HEAD
    + """<worldbody><body><joint name="lift" axis="0 1 0" damping="{d1}" limited="true"
range="-1.5 2"/><inertial pos="0 0 0.13" mass="0.4" diaginertia="1.5e-3 1.5e-3 2e-4"/>
<body pos="0 0 0.26"><joint name="bend" axis="0 1 0" damping="{d2}" limited="true"
range="-0.4 2.4"/><inertial pos="0 0 0.1" mass="0.22" diaginertia="7e-4 7e-4 1e-4"/></body></body>
</worldbody><actuator><position name="lift_goal" joint="lift" kp="{k1}" kv="0.5"/>
<position name="bend_goal" joint="bend" kp="{k2}" kv="0.3"/></actuator>
<sensor><jointpos name="lift_now" joint="lift"/><jointpos name="bend_now" joint="bend"/></sensor>
</mujoco>"""
)
# The same arm on a table: nothing weighs, and nothing limits its joints.
LYING = (
    LIFTING.replace('axis="0 1 0"', 'axis="0 0 1"')
    .replace("0 0 0.", "0.")
    .replace('pos="0.13"', 'pos="0.13 0 0"')
    .replace('pos="0.26"', 'pos="0.26 0 0"')
    .replace('pos="0.1"', 'pos="0.1 0 0"')
    .replace('limited="true"', "")
    .replace('range="-1.5 2"', "")
    .replace('range="-0.4 2.4"', "")
)
DRAWN = {"d1": 0.2, "d2": 0.12, "k1": 17, "k2": 10}
BUILT = {"d1": 0.16, "d2": 0.15, "k1": 15, "k2": 11}
COUNTS = 4096  # of an encoder in a turn


def goals(kind="steps", samples=500, seed=1):
    """Setpoints [rad], shape (samples, 2), every 20 ms: steps, slow waves, or small steps."""
    chance, t = np.random.default_rng(seed), 0.02 * np.arange(samples)
    middle, width = np.array([0.3, 0.9]), np.array([0.6, 0.7])
    if kind == "slow":
        return middle + width * np.sin(2 * np.pi * np.outer(t, [0.07, 0.11]) + [0, 1])
    u = np.zeros((samples, 2))
    for k in range(2):
        begin = 0
        while begin < samples:
            u[begin:, k] = chance.uniform(-1, 1)
            begin += int(chance.integers(15, 50))
    return middle + width * u * (0.06 if kind == "small" else 1)


def servo_log(text, u, std=4e-4, off=0.0, change=None, numbers=BUILT):
    """A log of the robot that was built, from rest at its first setpoints, with sensor noise."""
    model = mujoco.MjModel.from_xml_string(text.format(**numbers))
    if change is not None:
        change(model)
    model.opt.timestep = 0.0005
    begin = stepped(model, np.repeat(u[:1], 200, axis=0), u[0], 0.02)[-1]
    y = stepped(model, u, begin, 0.02) + off
    return model_log(model, u, y + noise(y.shape, std), 0.02)
