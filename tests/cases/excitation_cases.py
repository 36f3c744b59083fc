"""A slider whose answer is known on paper: m v' = u - c v, x' = v, from rest."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification import Parameter, ParameterSet
from identification.estimation.experiment import Experiment
from identification.model.paths import resolve
from identification.model.predictor import Numbers
from identification.model.rollout import State

XML = """
<mujoco>
  <option timestep="0.005" integrator="RK4" gravity="0 0 0"/>
  <worldbody>
    <body name="cart">
      <inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
      <joint name="slide" type="slide" axis="1 0 0" damping="3"/>
    </body>
  </worldbody>
  <actuator><motor name="push" joint="slide" gear="1"/></actuator>
  <sensor><jointpos name="position" joint="slide"/></sensor>
</mujoco>
"""
M, C, SIGMA, STEP = 2.0, 3.0, 1e-3, 0.02


@dataclass(frozen=True)
class Slider:
    model: mujoco.MjModel
    parameters: ParameterSet

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        n = len(values)
        numbers = [
            (resolve(self.model, self.parameters[name].where), column)
            for name, column in zip(names, values.T, strict=True)
        ]
        return State(np.zeros((n, 1)), np.zeros((n, 1)), np.zeros((n, 0))), numbers

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        return held

    def outputs(
        self, names: Sequence[str], values: np.ndarray, sensors: Sequence[str], readings: np.ndarray
    ) -> np.ndarray:
        return readings[0]


def slider() -> Slider:
    return Slider(
        mujoco.MjModel.from_xml_string(XML),
        ParameterSet("slider", (
            Parameter(name="mass", value=M, unit="kg", where="body/cart.mass",
                      lower=1e-3, upper=1e3),
            Parameter(name="damping", value=C, unit="N s/m", where="joint/slide.damping",
                      lower=0.0, upper=1e3),
            Parameter(name="gain", value=1.0, unit="", where="actuator/push.gear[0]",
                      lower=1e-3, upper=1e3),
        )),
    )  # fmt: skip


def pushed(inputs: np.ndarray | None = None, sigma: float = SIGMA) -> Experiment:
    """A step of 5 N, unless told otherwise."""
    inputs = np.full((101, 1), 5.0) if inputs is None else inputs
    return Experiment(
        plant=slider(), inputs=inputs, sampling_time=STEP, outputs=("position",), sigma=sigma
    )


def step_sensitivity(time: np.ndarray, u: float = 5.0) -> np.ndarray:
    """∂x/∂(ln m, ln c) of x = u/c (t - τ (1 - exp(-t/τ))), τ = m/c; shape (n, 2)."""
    tau = M / C
    e = np.exp(-time / tau)
    by_tau = u / C * (-(1 - e) + time / tau * e)
    x = u / C * (time - tau * (1 - e))
    return np.stack([tau * by_tau, -x - tau * by_tau], axis=1)
