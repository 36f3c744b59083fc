"""Small robots without any of INCA: a slider with a spring, and a pendulum of two links."""

from dataclasses import replace

import mujoco
import numpy as np
from plain_logs import plain_log

from identification import Parameter, ParameterSet
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor

STEP = 0.02  # between samples [s]

SLIDER = """<mujoco>
  <option timestep="0.005" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="cart"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
    <joint name="slide" type="slide" axis="1 0 0" stiffness="20" damping="3"/></body></worldbody>
  <actuator><motor name="force" joint="slide" gear="5"/></actuator>
  <sensor><jointpos name="position" joint="slide"/><jointvel name="rate" joint="slide"/></sensor>
</mujoco>"""

PENDULUM = """<mujoco>
  <option timestep="0.005" integrator="RK4"/>
  <worldbody><body name="upper"><joint name="shoulder" axis="0 1 0" damping="0.2"/>
    <inertial pos="0 0 -0.2" mass="1" diaginertia="0.01 0.01 0.01"/>
    <body name="lower" pos="0 0 -0.4"><joint name="elbow" axis="0 1 0" damping="0.1"/>
      <inertial pos="0 0 -0.15" mass="0.5" diaginertia="0.004 0.004 0.004"/></body></body>
  </worldbody>
  <actuator><motor name="torque" joint="shoulder" gear="2"/></actuator>
  <sensor><jointpos name="q1" joint="shoulder"/><jointpos name="q2" joint="elbow"/></sensor>
</mujoco>"""


def positive(name, value, unit, where):
    return Parameter(name=name, value=value, unit=unit, where=where, lower=0.0)


SLIDER_PARAMETERS = ParameterSet(
    "slider",
    (
        positive("mass", 2.0, "kg", "body/cart.mass"),
        positive("damping", 3.0, "N s/m", "joint/slide.damping"),
        positive("stiffness", 20.0, "N/m", "joint/slide.stiffness"),
        positive("gear", 5.0, "N", "actuator/force.gear[0]"),
        Parameter(name="x0", value=0.1, unit="m", where="qpos[0]"),
        Parameter(name="v0", value=0.0, unit="m/s", where="qvel[0]"),
    ),
)
PENDULUM_PARAMETERS = ParameterSet(
    "pendulum",
    (
        positive("upper_mass", 1.0, "kg", "body/upper.mass"),
        positive("lower_mass", 0.5, "kg", "body/lower.mass"),
        positive("upper_damping", 0.2, "N m s/rad", "joint/shoulder.damping"),
        positive("lower_damping", 0.1, "N m s/rad", "joint/elbow.damping"),
    ),
)


def slider(**values):
    model = mujoco.MjModel.from_xml_string(SLIDER)
    return ModelPlant(model, SLIDER_PARAMETERS.with_values(values))


def pendulum(**values):
    model = mujoco.MjModel.from_xml_string(PENDULUM)
    return ModelPlant(model, PENDULUM_PARAMETERS.with_values(values))


def steps(n, seed=1, hold=7):
    """A random input of levels ±1 that lasts `hold` samples each, shape (n, 1)."""
    return np.repeat(np.random.default_rng(seed).choice([-1.0, 1.0], n // hold + 1), hold)[:n, None]


def record(plant, outputs, n=250, noise=0.0, seed=0, inputs=None):
    """What a plant's sensors would have said, with white noise of std `noise`."""
    u = steps(n) if inputs is None else inputs
    y = np.zeros((len(u), len(outputs)))
    names = tuple(plant.model.actuator(i).name for i in range(plant.model.nu))
    log = plain_log(u, y, names, tuple(outputs), STEP)
    clean = Predictor(plant, log, ()).predict(np.empty((1, 0)))[0]
    return measured(log, clean + noise * np.random.default_rng(seed).standard_normal(y.shape))


def measured(log, outputs):
    return replace(log, outputs=outputs)
