"""Which currents make the twin follow a log? They tell which logged current belongs to which drive.

    i_k = K_p (y_k - φ_k) + K_d (ẏ_k - ω_k),    K_p = J Ω²/K_t,    K_d = 2 J Ω/K_t          [A]
    i_k ≈ Σ_m W_km (F u_m) + c_k,               F = (2 Ω s + Ω²)/(s + Ω)² = 2 L - L²,
                                                L = Ω/(s + Ω)

Under this feedback the motors of the twin follow the measured angles y whatever the logged currents
u are. i_k is then the current that drive k had, smoothed by the filter F. W is a least-squares fit
over all samples, and the best one-to-one choice of its entries says in which columns the currents
stand, and with which signs. The twin cannot drift away from the log, so that more than its first
motion is of use.

This is a proposal and no verdict. The verdict is a free run (`inca_mj.twin.other_currents`).
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from identification import Log
from identification.engine import quiet
from identification.model.rollout import hold, substeps
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.assignment import assigned
from inca_mj.twin.twin import Twin

BANDWIDTH = 40.0  # Ω of the feedback [rad/s]; 80 makes more of the encoders' noise
SETTLED = 5  # samples until the feedback has settled


def follow(
    plant: Twin, log: Log, drives: Sequence[int] = range(DRIVES)
) -> tuple[np.ndarray, np.ndarray] | None:
    """Simulate the twin with feedback of some drives; the others have their logged currents.

    Args:
        plant: the twin.
        log: n samples of all eight angles [rad].
        drives: that follow the log.

    Returns:
        Currents between samples, shape (n - 1, 8) [A], and angles, shape (n, 8) [rad]; None where
        they are not finite.
    """
    state, model, which = plant.state(), plant.model, [*drives]
    every = substeps(log.sampling_time, model.opt.timestep)
    y = hold(log.outputs - log.outputs[0], every, "foh")
    y_dot = np.gradient(y, model.opt.timestep, axis=0)
    J, K_t = (plant.parameters[name].value for name in ("J", "K_t"))
    K_p, K_d = J * BANDWIDTH**2 / K_t, 2 * J * BANDWIDTH / K_t
    currents = hold(log.inputs, every, log.hold)
    data, angles = mujoco.MjData(model), np.zeros((len(y) + 1, DRIVES))
    data.qpos[:], data.qvel[:], data.act[:] = state.qpos, state.qvel, state.act
    φ, ω = data.qpos[-DRIVES:], data.qvel[-DRIVES:]
    with quiet():
        for k in range(len(y)):
            currents[k, which] = (K_p * (y[k] - φ) + K_d * (y_dot[k] - ω))[which]
            data.ctrl[:DRIVES] = currents[k]
            mujoco.mj_step(model, data)
            angles[k + 1] = φ
    if not (np.isfinite(currents).all() and np.isfinite(angles).all()):
        return None
    return currents.reshape(-1, every, DRIVES).mean(axis=1), angles[::every]


def places_of(log: Log, currents: np.ndarray) -> np.ndarray:
    """Returns which logged current each drive had, and its sign, as a signed permutation (8, 8).

    Args:
        log: n samples.
        currents: of all drives under which the twin follows it, shape (n - 1, 8) [A].

    Returns:
        Entry k, m is 1 or -1 where column m is the current of drive k with this sign, and else 0.
    """
    W = shares_of(log, currents)
    k, m = np.arange(len(W)), assigned(np.abs(W))
    places = np.zeros_like(W)
    places[k, m] = np.where(W[k, m] < 0, -1.0, 1.0)
    return places


def shares_of(log: Log, currents: np.ndarray) -> np.ndarray:
    """Returns W: the share of each logged current in that of each drive, (8, 8), without unit.

    Args:
        log: n samples.
        currents: of all drives under which the twin follows it, shape (n - 1, 8) [A].
    """
    once = _low_pass(log.inputs, log.sampling_time)
    smoothed = (2 * once - _low_pass(once, log.sampling_time))[1:]
    regressors = np.column_stack([smoothed, np.ones(len(smoothed))])[SETTLED:]
    W: np.ndarray = np.linalg.lstsq(regressors, currents[SETTLED:], rcond=None)[0][:DRIVES].T
    return W


def _low_pass(signals: np.ndarray, sampling_time: float) -> np.ndarray:
    """Returns L of held signals, shape (n, 8), at their samples; at rest before the first one."""
    share, out = 1 - np.exp(-BANDWIDTH * sampling_time), signals.copy()
    for k in range(1, len(signals)):
        out[k] = out[k - 1] + share * (signals[k - 1] - out[k - 1])
    return out
