"""What the tests of the effects share: the whole catalogue compiled once, values, states."""

from functools import cache

import mujoco
import numpy as np
from plain_logs import plain_log

from identification.model.predictor import Predictor
from identification.model.rollout import State
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.effects.hooks import Drive
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS
from inca_mj.twin.twin import Twin, build_twin

BY_NAME = {effect.name: effect for effect in CATALOGUE}
EVERYWHERE = tuple(e for e in CATALOGUE if "all drives" in e.places)


@cache
def full(settled: bool = False) -> Twin:
    return build_twin(effects=CATALOGUE, settled=settled)


@cache
def bare() -> Twin:
    return build_twin()


def probes(effect, where=None, factor=1.0) -> dict[str, float]:
    """All sizes of an effect, at a place."""
    where = where or next(iter(effect.places))
    return {effect.parameter(s.name, where): factor * s.probe for s in effect.sizes}


def simulate(twin, names=(), values=None, seconds=0.5, currents=None) -> np.ndarray:
    """Angles of n value sets under the thesis' input, or some currents, shape (n, N, 8)."""
    u = make_input("prbs", seconds) if currents is None else currents
    log = plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)
    values = np.zeros((1, 0)) if values is None else np.asarray(values)
    return Predictor(twin, log, tuple(names)).predict(values)


def moving(twin, seed=1) -> State:
    """Near rest, turned and moving, every cable taut, the effects' own states off rest."""
    rng = np.random.default_rng(seed)
    at = twin.state()
    speed = np.concatenate([rng.normal(0, 0.05, 3), rng.normal(0, 0.2, 3), rng.normal(0, 2, 8)])
    angle = rng.normal(0, 0.01, 8)
    return State(np.concatenate([at.qpos[:7], angle]), speed, at.act)


def forward(twin, at: State, currents=0.0, time=0.0) -> mujoco.MjData:
    """Everything MuJoCo knows in a state."""
    data = mujoco.MjData(twin.model)
    data.qpos[:], data.qvel[:], data.act[:] = at.qpos, at.qvel, at.act
    data.time, data.ctrl[:] = time, currents
    mujoco.mj_forward(twin.model, data)
    return data


def drive(**known) -> Drive:
    """A drive of the thesis' robot, winding in at 3 rad/s, its cable at 4 N."""
    p = bare().parameters
    usual = dict(
        time=2.0, phi=0.7, omega=3.0, i=0.8, i_before=0.0, i_after=0.0, x=0.0,
        rx=1.2, ry=-1.4, rz=1.3, d=2.257, d_0=2.2567,
        strain=1.6e-4, strain_rate=0.01, T=4.0, F_s=11.0,
        R=p["R"].value, R_s=p["R_s"].value, k_s=p["k_s"].value, b_c=p["b_c"].value,
        beta=p["beta"].value, K_t=p["K_t"].value, lambda_=p["lambda"].value,
        b=p["b"].value, b_v=p["b_v"].value,
    )  # fmt: skip
    return Drive(**{**usual, **known})
