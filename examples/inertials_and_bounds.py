"""Inertias that joints cannot tell, and friction begun at its bound: MuJoCo's issue 3284.

    J₁ = I₁ + m₁ c₁² + m₂ l₁²,   J₂ = I₂ + m₂ c₂²,   h = m₂ l₁ c₂        a flat arm of two links

Torques and angles of this arm tell J₁, J₂ and h, three numbers, and never the six of which they
are made. A fit that asks no more ends with a tiny residual and masses that mean nothing. `assess`
says what cannot be known and gives no std to it, and the friction beside it keeps its own.

Friction that begins at 1e-8, a hair above its bound, is found over windows: each begins at a
state of its own, so that an arm without friction does not run away from the log. A free run from
there may end elsewhere, and then `fit_verdict` says that the residual is more than noise. A start
on the bound itself is refused, because a search that starts there stays there.

Run it: python examples/inertials_and_bounds.py
"""

from dataclasses import replace

import mujoco
import numpy as np

from identification import (
    Fit,
    InputError,
    Log,
    ModelPlant,
    Parameter,
    ParameterSet,
    Predictor,
    WindowEstimate,
    assess,
    estimate,
    estimate_windows,
    fit_verdict,
)

ARM = """<mujoco model="flat arm">
  <option timestep="0.005" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="upper">
    <joint name="shoulder" axis="0 0 1"/>
    <inertial pos="0.14 0 0" mass="1.7" diaginertia="0.024 0.024 0.024"/>
    <body name="fore" pos="0.3 0 0">
      <joint name="elbow" axis="0 0 1"/>
      <inertial pos="0.11 0 0" mass="0.9" diaginertia="0.007 0.007 0.007"/>
    </body>
  </body></worldbody>
  <actuator>
    <motor name="torque_1" joint="shoulder"/><motor name="torque_2" joint="elbow"/>
  </actuator>
  <sensor>
    <jointpos name="angle_1" joint="shoulder"/><jointpos name="angle_2" joint="elbow"/>
  </sensor>
</mujoco>"""


def positive(name: str, value: float, unit: str, where: str) -> Parameter:
    """A parameter above zero; the value is that of the arm which is recorded."""
    return Parameter(name=name, value=value, unit=unit, where=where, lower=0.0)


PARAMETERS = ParameterSet(
    "arm",
    (
        positive("m_1", 1.7, "kg", "body/upper.mass"),
        positive("c_1", 0.14, "m", "body/upper.ipos[0]"),
        positive("I_1", 0.024, "kg m^2", "body/upper.inertia[2]"),
        positive("m_2", 0.9, "kg", "body/fore.mass"),
        positive("c_2", 0.11, "m", "body/fore.ipos[0]"),
        positive("I_2", 0.007, "kg m^2", "body/fore.inertia[2]"),
        positive("d_1", 0.25, "N m s/rad", "joint/shoulder.damping"),
        positive("d_2", 0.08, "N m s/rad", "joint/elbow.damping"),
    ),
)
EVERY = tuple(parameter.name for parameter in PARAMETERS.records)
FRICTION = ("d_1", "d_2")
DRAWING = {"m_1": 1.5, "c_1": 0.15, "I_1": 0.02, "m_2": 0.8, "c_2": 0.1, "I_2": 0.006}


def arm() -> ModelPlant:
    """The arm, with the values of the one that is recorded."""
    return ModelPlant(mujoco.MjModel.from_xml_string(ARM), PARAMETERS)


def record(samples: int = 300, noise: float = 1e-4) -> Log:
    """A log of the arm: torques [N m] and angles [rad] at 100 Hz."""
    chance, time = np.random.default_rng(0), np.arange(samples) * 0.01
    waves = 2 * np.pi * chance.uniform(0.3, 2.5, (4, 2)) * time[:, None, None]
    torques = np.sin(waves + chance.uniform(0, 6, (4, 2))).sum(1) * [0.6, 0.25]
    log = Log(
        time=time,
        inputs=torques,
        outputs=np.zeros((samples, 2)),
        input_names=("torque_1", "torque_2"),
        output_names=("angle_1", "angle_2"),
        units={"angle_1": "rad", "angle_2": "rad"},
    )
    angles = Predictor(arm(), log, FRICTION).predict(np.array([[0.25, 0.08]]))[0]
    return replace(log, outputs=angles + noise * chance.standard_normal(angles.shape))


def from_drawing(log: Log) -> Fit:
    """All parameters from a free run of the log, beginning at the drawing's values."""
    return assess(estimate(arm(), log, EVERY, {**DRAWING, "d_1": 0.2, "d_2": 0.1}))


def friction_from(start: float, log: Log) -> WindowEstimate:
    """Both frictions from windows of 0.5 s; the inertials are those of the arm."""
    return estimate_windows(arm(), log, FRICTION, 0.5, dict.fromkeys(FRICTION, start))


if __name__ == "__main__":
    log = record()
    print("All six inertials and both frictions, from the drawing:")
    fit = from_drawing(log)
    print(*fit_verdict(fit), sep="\n")
    for (name, value), std in zip(fit.estimate.values.items(), fit.std, strict=True):
        print(f"  {name}  {value:.5g}  " + ("std unknown" if np.isinf(std) else f"± {std:.2g}"))
    print("\nBoth frictions, from 1e-8:")
    for name, value in friction_from(1e-8, log).values.items():
        print(f"  {name}  {value:.5g}")
    try:
        friction_from(0.0, log)
    except InputError as error:
        print("\nFrom the bound itself:", error)
