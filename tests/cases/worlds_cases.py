"""Short plants and inputs for the laws of the worlds."""

import numpy as np

from inca_mj.reference import layout as base
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies.worlds import (
    CHANGES,
    HIDDEN_EFFECTS,
    SHAPES,
    UNLISTED,
    HiddenPlant,
    HiddenSetting,
    make_currents,
    make_plant,
)
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds import simulate_world as simulate
from inca_mj.studies.worlds.equations import world_rate

TRIAL = parameter_set("trial")
FINE = 5e-4  # a sampling time of one step [s]
ALL = [(name, False) for name in (*HIDDEN_EFFECTS, *UNLISTED, *CHANGES)]  # not what encoders say
ALL += [(name, True) for name in SHAPES]


def plant(*effects, parameters=TRIAL, geometry=INCA) -> HiddenPlant:
    return make_plant(parameters, geometry, effects)


def prbs(duration: float = 1.0) -> np.ndarray:
    return make_currents(5, HiddenSetting(duration=duration))


def angles(effects, u, sampling_time=0.01, **options) -> np.ndarray:
    return simulate(plant(*effects, **options), u, sampling_time)[:, base.ANGLES]


def fine(u: np.ndarray) -> np.ndarray:
    """Each row of an input at 100 Hz, as rows of FINE."""
    return np.repeat(u, round(0.01 / FINE), axis=0)


def rate(p: HiddenPlant, x: np.ndarray, i: np.ndarray, t: float = 0.0) -> np.ndarray:
    out = np.empty(at.STATES)
    world_rate(t, x, i, p.q, p.D, p.P, out)
    return out
