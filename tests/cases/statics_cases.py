"""Robots and poses of the tests of statics."""

import numpy as np
from hypothesis import strategies as st
from scipy.optimize import linprog

from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import parameter_set
from inca_mj.statics.robot import static_robot

ROBOT = static_robot(parameter_set("trial"), INCA)

_across, _angle = st.floats(-0.7, 0.7), st.floats(-0.2, 0.2)
_places = (_across, _across, st.floats(0.9, 2.2), _angle, _angle, _angle)
poses = st.tuples(*_places).map(np.array)


def random_poses(count, seed=0, across=1.4):
    rng = np.random.default_rng(seed)
    low, high = [-across, -across, 0.2, -0.2, -0.2, -0.2], [across, across, 2.9, 0.2, 0.2, 0.2]
    return rng.uniform(low, high, (count, 6))


def possible(W, w, low, high):
    """Whether a linear program finds tensions within the limits that exert w."""
    bounds = list(zip(np.broadcast_to(low, 8), np.broadcast_to(high, 8), strict=True))
    return linprog(np.zeros(8), A_eq=W, b_eq=w, bounds=bounds, method="highs").success


def _layout(connectors, source):
    return Geometry(INCA.exits, tuple(map(tuple, connectors)), True, source)


# Both cables of a vertical edge end in one connector: rank 6, and no tension is positive.
EDGES = _layout(
    [(0.05, 0, 0), (0, 0.05, 0), (-0.05, 0, 0), (0, -0.05, 0)] * 2, "one connector for each edge"
)
# Cables that all point at the vertical axis of the platform cannot turn it about that axis.
RADIAL = _layout(
    [(0.05, 0.05, 0), (-0.05, 0.05, 0), (-0.05, -0.05, 0), (0.05, -0.05, 0)] * 2, "radial"
)
