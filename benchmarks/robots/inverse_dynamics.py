"""Joint torques that a motion needs, from a model, and the same motion smoothed to have rates.

    τ = M(q) q̈ + C(q, q̇) q̇ + G(q)                     MuJoCo's, without damping and friction

Rates come from angles below `SMOOTH`; torques are compared after both sides went through one low
pass, forwards and backwards, so that nothing is delayed. To filter angles as narrowly as torques
would be wrong: the equations are not linear in them.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.signal import butter, filtfilt

SMOOTH = 25.0  # [Hz]; faster, quantisation makes the acceleration
EDGE = 0.3  # left out at both ends, where a filter knows one side only [s]
ORDER = 3


@dataclass(frozen=True)
class Motion:
    """A smoothed motion on an even grid, and what drove it."""

    step: float  # of the grid [s]
    q: np.ndarray  # angles, shape (n, nv) [rad]
    v: np.ndarray  # speeds, shape (n, nv) [rad/s]
    a: np.ndarray  # accelerations, shape (n, nv) [rad/s^2]
    drive: np.ndarray  # torques or currents, not filtered, shape (n, nu)

    def low(self, x: np.ndarray, band: float) -> np.ndarray:
        """Columns (n, …) of this grid below a frequency [Hz], without the ends."""
        n = round(EDGE / self.step)
        return low_pass(x, band, self.step)[n : len(x) - n]


def low_pass(x: np.ndarray, band: float, step: float) -> np.ndarray:
    """Columns below a frequency [Hz], forwards and backwards."""
    b, a = butter(ORDER, band * 2 * step)
    return filtfilt(b, a, x, axis=0)


def smoothed(time: np.ndarray, angles: np.ndarray, drive: np.ndarray, step: float) -> Motion:
    """A measured motion on an even grid, with its rates.

    Args:
        time: stamps, shape (n,) [s].
        angles: shape (n, nv) [rad].
        drive: torques or currents, shape (n, nu).
        step: of the grid [s].
    """
    t = np.arange(time[0], time[-1], step)
    raw, u = (np.column_stack([np.interp(t, time, c) for c in x.T]) for x in (angles, drive))
    q = low_pass(raw, SMOOTH, step)
    v = np.gradient(q, step, axis=0)
    return Motion(step, q, v, np.gradient(v, step, axis=0), u)


def torques(model: mujoco.MjModel, motion: Motion) -> np.ndarray:
    """Torques at the joints that a motion needs without friction, shape (n, nv) [N m].

    Args:
        model: its damping and its frictionloss are not counted.
        motion: with as many angles as the model has joints.
    """
    bare = copy(model)
    bare.dof_damping[:] = 0.0
    bare.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    data = mujoco.MjData(bare)
    found = np.zeros_like(motion.q)
    for k, (q, v, a) in enumerate(zip(motion.q, motion.v, motion.a, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(bare, data)
        found[k] = data.qfrc_inverse
    return found


def gravity(model: mujoco.MjModel, motion: Motion) -> np.ndarray:
    """Torques at the joints that hold the robot still in the poses of a motion, (n, nv) [N m]."""
    still = Motion(motion.step, motion.q, 0 * motion.v, 0 * motion.a, motion.drive)
    return torques(model, still)


def rms(x: np.ndarray) -> list[float]:
    """Of each column."""
    return np.sqrt(np.mean(x**2, axis=0)).tolist()
