"""A slider and an arm with every effect compiled in, and the forces of their effects by hand."""

from functools import cache

import numpy as np
from plain_logs import plain_log

from identification.effects.plant.joint_plant import JointPlant, joint_plant
from identification.effects.values import numbers_at
from identification.model.parameter import Parameter
from identification.model.predictor import Predictor
from identification.native.joints.joint_callback import Joint

STEP = 0.01  # between samples [s]
SLIDER = """<mujoco model="slider">
  <option timestep="0.002" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="cart"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
    <joint name="slide" type="slide" axis="1 0 0" damping="3"/></body></worldbody>
  <actuator><general name="force" joint="slide" gear="5" ctrlrange="-3 3" ctrllimited="true"/>
  </actuator>
  <sensor><jointpos name="position" joint="slide"/></sensor>
</mujoco>"""
ARM = """<mujoco model="arm">
  <option timestep="0.001" integrator="RK4"/>
  <worldbody><body name="upper"><joint name="shoulder" axis="0 1 0" damping="0.2"/>
    <inertial pos="0 0 -0.2" mass="1" diaginertia="0.02 0.02 0.01"/>
    <body name="lower" pos="0 0 -0.4"><joint name="elbow" axis="0 1 0" damping="0.1"/>
      <inertial pos="0 0 -0.1" mass="0.5" diaginertia="0.01 0.01 0.005"/></body></body></worldbody>
  <actuator><general name="up" joint="shoulder" gear="2" biastype="affine"
      biasprm="0.1 -0.3 -0.05"/>
    <general name="low" joint="elbow" gear="0.5" forcerange="-0.4 0.4" forcelimited="true"/>
  </actuator>
  <sensor><jointpos name="a" joint="shoulder"/><jointpos name="b" joint="elbow"/></sensor>
</mujoco>"""
MASS = Parameter(name="mass", value=2.0, unit="kg", where="body/cart.mass", lower=0.0, upper=100.0)
DAMPING = Parameter(
    name="damping", value=3.0, unit="N s/m", where="joint/slide.damping", lower=0.0, upper=100.0
)


def steps(samples, nu=1, seed=1, hold=20):
    """A random input of levels ±1 that lasts `hold` samples each, shape (N, nu)."""
    levels = np.random.default_rng(seed).choice([-1.0, 1.0], (samples // hold + 1, nu))
    return np.repeat(levels, hold, axis=0)[:samples]


def slider_log(u, y=None):
    moved = 0.3 * np.sin(np.arange(len(u)) * STEP)[:, None] if y is None else y
    return plain_log(u, moved, "force", "position", STEP, units={"force": "V"})


def arm_log(u):
    t = np.arange(len(u)) * STEP
    return plain_log(u, np.stack([np.sin(2 * t), np.cos(3 * t)], axis=1), "up low", "a b", time=t)


@cache
def slider() -> JointPlant:
    return joint_plant(SLIDER, (MASS, DAMPING), slider_log(steps(400)))


@cache
def arm() -> JointPlant:
    return joint_plant(ARM, (), arm_log(steps(100, 2)))


def run(plant, log, **values):
    """Outputs of one value set, shape (N, ny)."""
    names = tuple(values)
    return Predictor(plant, log, names).predict(np.array([[values[n] for n in names]]))[0]


def stopping_time(plant, joint):
    """T of a joint: its row is the one before the user data end with key and tag [s]."""
    return float(plant.model.jnt_user[plant.model.joint(joint).id, -plant.layout.entries])


def reached(plant, joint):
    """What the records of a joint reach, which stands behind T: the last fields of its state."""
    row = plant.model.jnt_user[plant.model.joint(joint).id, -plant.layout.entries :]
    return row[1:6].tolist()


def share(plant, joint, q):
    """Where a joint is in its travel, (q - q_mid)/q_far, as its neighbours see it."""
    middle, far = reached(plant, joint)[:2]
    return (q - middle) / far


def sums(plant, joint, values):
    """Force and largest friction of a joint in plain Python, each a function of `Joint`."""
    every = {**plant.parameters.values(), **values}
    laws = {
        hook: [(e.hooks[hook].py_func, tuple(numbers_at(e, joint, every)), len(e.sizes))
               for e in plant.effects if hook in e.hooks]
        for hook in ("force", "friction")
    }  # fmt: skip

    def total(hook, s):
        return sum(law(s, p) for law, p, sizes in laws[hook] if any(p[:sizes]))

    return lambda s: total("force", s), lambda s: max(0.0, total("friction", s))


def seen(plant, joint, q, v, f_u, f_g, time):
    """What the effects of a joint see."""
    return Joint(time, q, v, f_u, f_g, 0.0, *reached(plant, joint))


def forces(plant, joint, values):
    """What acts on a joint that is held by itself: (q, v, f_u, f_g, passive, M, time) -> f."""
    total, largest = sums(plant, joint, values)
    T = stopping_time(plant, joint)

    def force(q, v, f_u, f_g, passive, M, time):
        s = seen(plant, joint, q, v, f_u, f_g, time)
        f = total(s)
        r = M * v / T + f_u + f_g + passive + f
        b = largest(s._replace(sign=1.0 if r > 0 else -1.0))
        return f - max(-b, min(b, r))

    return force
