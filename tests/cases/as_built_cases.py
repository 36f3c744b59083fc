"""A robot whose drives differ in torque constant and viscous friction, and logs of it."""

from dataclasses import replace
from functools import cache

import numpy as np

from identification import Log
from inca_mj.robot.inputs import prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.spread import Spread

NOISE = 5e-4  # [rad]
SPREAD = Spread({"K_t": 0.02, "b_v": 0.1}, {}, 0.0, "the tests")
COMMON = {"K_t": 0.078, "J": 8.2e-5}
STEP = 2e-3  # [s]


def deviations(seed: int = 0) -> dict[str, float]:
    """A draw of all deviations, of mean zero in each group, so that common values are known."""
    rng, out = np.random.default_rng(seed), {}
    for group, names in SPREAD.groups.items():
        drawn = SPREAD.drives[group] * rng.standard_normal(len(names))
        out.update(zip(names, (drawn - drawn.mean()).tolist(), strict=True))
    return out


@cache
def robot_as_built(alike: bool = False) -> Twin:
    """The robot; `alike` if its drives do not differ."""
    own = {} if alike else deviations()
    values = with_spread(parameter_set()).with_values(own | COMMON)
    return build_twin(values, timestep=STEP, visual=False)


@cache
def log_as_built(seconds: float, seed: int = 0, x: float = 0.0, alike: bool = False) -> Log:
    """A log of it with white noise, under a PRBS of its own, from a start of its own."""
    currents = prbs(round(100 * seconds), 0.01, seed=seed)
    run = simulate(robot_as_built(alike).with_values({"x": x}), currents)
    log = run_to_log(run, f"record {seed}")
    noise = NOISE * np.random.default_rng(seed).standard_normal(log.outputs.shape)
    return replace(log, outputs=log.outputs + noise, extras={}, units={})
