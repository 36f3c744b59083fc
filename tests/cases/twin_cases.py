"""States, inputs and comparisons that the tests of the twin share."""

import mujoco
import numpy as np
from hypothesis import strategies as st
from mujoco.batch import Batch

from identification.model.rollout import State, rollout
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.twin import build_twin
from inca_mj.verification.derivatives import random_states, to_mujoco

STEP = 1e-3  # [s]

# Looks, names and text: no number of these enters a force or a length.
LOOKS = ("cam_", "geom_", "light_", "mat_", "tex", "vis", "name", "text", "site_size", "site_rgba",
         "tendon_rgba", "tendon_width", "bvh_", "body_bvh", "oct_", "paths",
         "dof_length")  # fmt: skip
# Where a free body stands and how long its cables are when the model was compiled: the state
# replaces the first, and springs of zero stiffness do not read the second.
UNREAD = {"body_pos", "body_quat", "qpos_spring", "tendon_lengthspring"}

seeds = st.integers(0, 2**32 - 1)
sets = st.sampled_from(("simulation", "trial"))


def near(name: str, value: float) -> st.SearchStrategy[float]:
    """Values around a nominal one; no body has one moment of inertia above the other two's sum."""
    spread = 1.1 if name.startswith("I_") else 2.0
    return st.floats(1 / spread, spread).map(lambda factor: factor * value)


laws = st.fixed_dictionaries(
    {p.name: near(p.name, p.value) for p in parameter_set() if p.where != "start"}
)


def random_state(seed: int, n: int = 1) -> tuple[State, np.ndarray]:
    """States far from rest, about half of the cables slack, and currents (n, 8) [A]."""
    rng = np.random.default_rng(seed)
    return to_mujoco(random_states(n, INCA, rng)), rng.normal(0, 2, (n, 8))


def moving(seed: int) -> State:
    """Near rest, moving, every cable taut."""
    rng = np.random.default_rng(seed)
    at = build_twin().state()
    speed = np.concatenate([rng.normal(0, 0.02, 3), rng.normal(0, 0.2, 3), rng.normal(0, 0.5, 8)])
    return State(at.qpos, speed, at.act)


def every_step(robot, start: State, currents: np.ndarray, record=("qpos", "qvel", "act")):
    """The run at every simulation step, currents (N, 8) one row a step: arrays (N, size)."""
    h = robot.model.opt.timestep
    runs = rollout(robot.model, start, currents, h, record=record)
    return {name: array[0] for name, array in runs.items()}


def forward(model, at: State, ctrl, fields):
    """MjData fields in given states, one row each."""
    batch = Batch(model, len(at.qpos), 1)
    for name in ("qpos", "qvel", "act"):
        batch.bind(name)[:] = getattr(at, name)
    batch.bind("ctrl")[:] = ctrl
    found = [batch.bind(name) for name in fields]
    batch.forward()
    return [np.array(array) for array in found]


def arrays(model) -> dict[str, np.ndarray]:
    """Every array of an mjModel, and the numbers of its options."""
    found = {}
    for owner in (model, model.opt):
        for name in dir(owner):
            value = None if name.startswith("_") else getattr(owner, name, None)
            if isinstance(value, np.ndarray | int | float):
                found[name] = np.array(value)
    return found


def is_looks(name: str) -> bool:
    return name.startswith(LOOKS) or name in ("signature", "nbuffer")


def differing(a: mujoco.MjModel, b: mujoco.MjModel) -> set[str]:
    """Names of the arrays of physics in which two models differ, by one bit or more."""
    ours, theirs = arrays(a), arrays(b)
    assert ours.keys() == theirs.keys()
    return {
        name
        for name in ours
        if not is_looks(name) and not np.array_equal(ours[name], theirs[name], equal_nan=True)
    }
