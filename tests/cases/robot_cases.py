"""A slider told in TOML, records of it, and the commands on them."""

import json
from dataclasses import replace

import numpy as np
from joint_cases import DAMPING, MASS, SLIDER, slider_log, steps

from identification import Predictor
from identification.__main__ import main
from identification.effects.plant.joint_plant import joint_plant
from identification.logs.formats.csv_files import write_log

# An arm of two joints, without actuators and sensors unless `rest` has them.
ARM = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
<body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" damping="{damping}"/>
<inertial pos="0 0 -0.2" mass="1.2" diaginertia="0.012 0.012 0.001"/>
<body name="lower" pos="0 0 -0.4"><joint name="elbow" axis="0 1 0" damping="0.2"/>
<inertial pos="0 0 -0.15" mass="0.6" diaginertia="0.006 0.006 0.001"/></body></body>
</worldbody>{rest}</mujoco>"""
TRUTH = {"damping": 3.6, "mass": 1.8, "stribeck_friction.f_s": 0.0}
HIDDEN = {"asymmetric_viscous_friction.d_a@slide": 0.9}
NAMES = ("mass", "joint/slide.damping", "qpos[0]", "qvel[0]")
TOML = """
model = "slider.xml"
free = ["mass", "joint/slide.damping", "qpos[0]", "qvel[0]"]
[columns]
position = "x"
[parameters.mass]
path = "body/cart.mass"
unit = "kg"
"""


def simulated(values, samples=1200, seed=1, start=0.0):
    """A record of the slider with other values, half a millimetre of noise on it."""
    u = steps(samples, seed=seed)
    log = slider_log(u)
    plant = joint_plant(SLIDER, (MASS, DAMPING), log)
    y = Predictor(plant, log, (), values).predict(np.empty((1, 0)))[0]
    noise = 5e-4 * np.random.default_rng(seed).standard_normal(y.shape)
    return replace(slider_log(u, y + start + noise), output_names=("x",), units={})


def write_slider(folder, samples=200, toml=TOML, model=SLIDER):
    """Writes a robot and a short log of it into a folder; returns both paths."""
    (folder / "slider.xml").write_text(model)
    (folder / "robot.toml").write_text(toml)
    write_log(simulated({"damping": 3.0, "mass": 2.0}, samples), folder / "log.csv")
    return folder / "robot.toml", folder / "log.csv"


def run(capsys, *arguments):
    assert main([*map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refused(capsys, *arguments):
    assert main([*map(str, arguments)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    return error
