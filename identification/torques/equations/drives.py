"""The forces of a robot's drives along a measured motion, with inputs that may act later.

    F(t) = f(u(t - τ), q(t), q̇(t))

A log has a sample of u every h, which acts from its stamp to the next one (`zoh`), or changes in
straight lines (`foh`). The equations take what is slow in it. The mean of two samples would be too
smooth by (ωh)²/12 against the force that a robot feels: a servo's force is a small difference of
setpoint and position, of which that is no small part.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.model.rollout import logged_inputs
from identification.runtime.engine import quiet
from identification.torques.equations.smoothing import Motion

TAPS = 4  # samples of an input, of which it is made at another time


def input_at(u: np.ndarray, h: float, shift: float, is_held: bool) -> np.ndarray:
    """Returns inputs (n, nu) that act by a time later, without what is faster than the samples.

    Each sample, one every h [s], acts from its stamp to the next one where inputs are held. The
    weights of a few samples have the moments of this box, so that a slow input comes as late and as
    smooth as the force that the robot felt.
    """
    middle = shift / h + is_held / 2
    taps = int(np.floor(middle)) + np.arange(TAPS) - TAPS // 2 + 1
    moments = np.array([1.0, 0.0, is_held / 12, 0.0])
    weights = np.linalg.solve(np.vander(taps - middle, TAPS, increasing=True).T, moments)
    n = np.arange(len(u))
    return np.asarray(
        sum(w * u[np.clip(n - k, 0, len(u) - 1)] for w, k in zip(weights, taps, strict=True))
    )


def without_constraints(model: mujoco.MjModel) -> mujoco.MjModel:
    """Returns a model without contacts, limits and dry friction, which no equation has."""
    bare, off = copy.copy(model), mujoco.mjtDisableBit
    bare.opt.disableflags |= int(off.mjDSBL_CONSTRAINT) | int(off.mjDSBL_CONTACT)
    return bare


@quiet()
def inverse_forces(model: mujoco.MjModel, motion: Motion) -> np.ndarray:
    """Returns the forces of inverse dynamics, shape (n, nv)."""
    data, out = mujoco.MjData(model), np.empty_like(motion.q)
    for k in range(len(out)):
        data.qpos, data.qvel, data.qacc = motion.q[k], motion.v[k], motion.a[k]
        mujoco.mj_inverse(model, data)
        out[k] = data.qfrc_inverse
    return out


@quiet()
def drive_forces(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray, log: Log, shifts: Sequence[float]
) -> np.ndarray:
    """Returns the forces of each actuator with inputs at other times, (len(shifts), n, nv, nu)."""
    u = np.array([input_at(log.inputs, log.sampling_time, s, log.hold == "zoh") for s in shifts])
    data, n, logged = mujoco.MjData(model), len(q), logged_inputs(model)
    out, moment = np.zeros((len(shifts), n, model.nv, model.nu)), np.zeros((model.nu, model.nv))
    for k in range(n):
        data.qpos, data.qvel = q[k], v[k]
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mju_sparse2dense(
            moment, data.actuator_moment, data.moment_rownnz, data.moment_rowadr,
            data.moment_colind,
        )  # fmt: skip
        for i in range(len(shifts)):
            data.ctrl[:logged] = u[i, k]
            mujoco.mj_fwdActuation(model, data)
            out[i, k] = (moment * data.actuator_force[:, None]).T
    return out
