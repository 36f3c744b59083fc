"""Random states of the robot, and the state without the rest of it."""

import numpy as np
from hypothesis import strategies as st

from identification.model.parameter import ParameterSet
from inca_mj.reference import layout as at
from inca_mj.reference import rest
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import SETS, parameter_set
from inca_mj.robot.spread import DRIVE, POINT, with_spread

FORCE, FORCE_AT = (0.3, -0.2, 0.5), (0.01, 0.02, -0.03)


def random_state(seed: int) -> np.ndarray:
    """A state far from rest; about half of its cables are slack."""
    rng = np.random.default_rng(seed)
    x = np.empty(at.STATES)
    x[at.POSITION] = rng.uniform([-1, -1, 0.4], [1, 1, 2.6])
    x[at.VELOCITY] = rng.normal(0, 1, 3)
    x[at.EULER] = rng.uniform(-1.2, 1.2, 3)
    x[at.RATES] = rng.normal(0, 3, 3)
    x[at.ANGLES] = rng.normal(0, 30, 8)
    x[at.SPEEDS] = rng.normal(0, 20, 8)
    R_AB = plain_rotation(x[at.EULER])
    d = np.linalg.norm(x[at.POSITION] + INCA.B @ R_AB.T - INCA.A, axis=1)
    x[at.NO_LOAD] = d / (1 + rng.uniform(-1e-3, 1e-3, 8))
    return x


def plain_rotation(euler: np.ndarray) -> np.ndarray:
    from scipy.spatial.transform import Rotation

    return Rotation.from_euler("xyz", euler).as_matrix()


def taut(seed: int) -> np.ndarray:
    """A start state near rest, moving, every cable taut."""
    rng = np.random.default_rng(seed)
    x = rest(parameter_set(), INCA).state.copy()
    x[at.VELOCITY] = rng.normal(0, 0.02, 3)
    x[at.RATES] = rng.normal(0, 0.2, 3)
    x[at.SPEEDS] = rng.normal(0, 0.5, 8)
    return x


def differing(seed: int, drives: float = 0.2, points: float = 0.01) -> ParameterSet:
    """A robot whose drives all differ by up to `drives`, and its points by up to `points` [m]."""
    spread = with_spread(parameter_set())
    largest = {DRIVE: drives, POINT: points}
    of = {p.name: largest[p.where] for p in spread if p.where in largest}
    parts = np.random.default_rng(seed).uniform(-1, 1, len(of))
    return spread.with_values({n: of[n] * x for n, x in zip(of, parts, strict=True)})


seeds = st.integers(0, 2**32 - 1)
states = st.builds(random_state, seeds)
currents = st.builds(lambda seed: np.random.default_rng(seed).normal(0, 2, 8), seeds)
sets = st.sampled_from(SETS)
