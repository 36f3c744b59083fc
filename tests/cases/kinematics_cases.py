"""Poses inside the frame, and a robot that comes to rest quickly."""

import numpy as np
from hypothesis import strategies as st

from inca_mj.robot.geometry import Geometry
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import build_twin

INSIDE = st.tuples(
    *(st.floats(-0.8, 0.8) for _ in range(2)), st.floats(0.6, 2.4), *(st.floats(-0.6, 0.6),) * 3
).map(np.array)
TWIST = st.tuples(*(st.floats(-2, 2),) * 6).map(np.array)

FLAT = Geometry(  # everything in one plane: half of the motions change no length
    exits=tuple((x, y, 1.0) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)) * 2),
    connectors=tuple((x, y, 0.0) for x, y in ((0.1, 0), (0, 0.1), (-0.1, 0), (0, -0.1)) * 2),
    assumed=True,
    source="a test",
)


def settled_run(seconds: float = 14.0) -> Run:
    """Steady currents, switched on slowly, until the robot rests."""
    parameters = parameter_set("trial", {"b_c": 0.0, "b_v": 6e-4})
    t = np.arange(round(seconds / 0.01)) * 0.01
    steady = np.array([1.6, 0.6, 0.4, 1.2, 1.5, 0.5, 0.3, 1.0])
    return simulate(build_twin(parameters), np.minimum(t / 3, 1)[:, None] * steady)


def measured_angles(run: Run, seed: int = 0) -> np.ndarray:
    """Angles as an encoder of 4000 counts with 0.5 mrad of noise shows them."""
    count = 2 * np.pi / 4000
    noise = np.random.default_rng(seed).normal(0, 5e-4, run.motor_angle.shape)
    return np.round((run.motor_angle + noise) / count) * count


def moving_run(kind: str, seconds: float, values: dict[str, float] | None = None) -> Run:
    return simulate(build_twin(parameter_set("trial", values)), make_input(kind, seconds, 0.01))
