"""Forces on the joints by bodies that move as a log says, all samples at once.

    F = m J_cᵀ a_c + J_ωᵀ (I α + ω × I ω)                       of a body by itself
    F = J(p)ᵀ a(p),    J(p) = J_c - [r]× J_ω,    r = R p        of 1 kg at a point p of it
    a(p) = a_c + α × r + ω × (ω × r)
    F = J(p)ᵀ e                                                 of 1 N along an axis e of the world

c: centre of mass, ω, α: angular velocity and acceleration, J_c, J_ω: Jacobians, I: inertia in the
axes of the world, R: axes of the body.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np


@dataclass(frozen=True)
class MovingBody:
    """One body at n samples, in the axes of the world.

    Attributes:
        J_c: of its centre of mass, shape (n, 3, nv).
        J_ω: of its rotation, shape (n, 3, nv).
        a_c: acceleration of its centre of mass, without gravity, shape (n, 3) [m/s^2].
        ω: angular velocity, shape (n, 3) [rad/s].
        α: angular acceleration, shape (n, 3) [rad/s^2].
        R: its axes, shape (n, 3, 3).
        R_i: axes of its inertia, shape (n, 3, 3).
    """

    J_c: np.ndarray
    J_ω: np.ndarray
    a_c: np.ndarray
    ω: np.ndarray
    α: np.ndarray
    R: np.ndarray
    R_i: np.ndarray


def follow_bodies(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray, a: np.ndarray, bodies: Sequence[int]
) -> dict[int, MovingBody]:
    """Returns some bodies of a robot of hinges and slides along a motion.

    Args:
        model: of the robot.
        q: positions, shape (n, nv) [rad or m].
        v: velocities, shape (n, nv).
        a: accelerations, shape (n, nv).
        bodies: their indices.
    """
    free = copy.copy(model)
    free.opt.gravity[:] = 0.0
    data, n, nv = mujoco.MjData(free), len(q), model.nv
    J = np.zeros((len(bodies), 2, n, 3, nv))
    acceleration, axes = np.zeros((len(bodies), n, 6)), np.zeros((len(bodies), 2, n, 9))
    for k in range(n):
        data.qpos, data.qvel, data.qacc = q[k], v[k], a[k]
        mujoco.mj_kinematics(free, data)
        mujoco.mj_comPos(free, data)
        mujoco.mj_comVel(free, data)
        mujoco.mj_rnePostConstraint(free, data)  # accelerations of the bodies
        for i, b in enumerate(bodies):
            mujoco.mj_jacBodyCom(free, data, J[i, 0, k], J[i, 1, k], b)
            mujoco.mj_objectAcceleration(
                free, data, mujoco.mjtObj.mjOBJ_BODY, b, acceleration[i, k], 0
            )
            axes[i, 0, k], axes[i, 1, k] = data.xmat[b], data.ximat[b]
    return {
        b: MovingBody(
            J_c=J[i, 0], J_ω=J[i, 1], a_c=acceleration[i, :, 3:], α=acceleration[i, :, :3],
            ω=np.einsum("kcj,kj->kc", J[i, 1], v),
            R=axes[i, 0].reshape(n, 3, 3), R_i=axes[i, 1].reshape(n, 3, 3),
        )
        for i, b in enumerate(bodies)
    }  # fmt: skip


def inertial_force(body: MovingBody, mass: float, inertia: np.ndarray) -> np.ndarray:
    """Returns the forces that move a body, shape (n, nv).

    Args:
        body: along the motion.
        mass: [kg].
        inertia: about its own axes, shape (3,) [kg m^2].
    """
    In = body.R_i @ (inertia[:, None] * np.swapaxes(body.R_i, 1, 2))
    turned, twisted = (np.einsum("kij,kj->ki", In, x) for x in (body.ω, body.α))
    torque = twisted + np.cross(body.ω, turned)
    return mass * _on_joints(body.J_c, body.a_c) + _on_joints(body.J_ω, torque)


def point_force(body: MovingBody, p: np.ndarray) -> np.ndarray:
    """Returns the forces that move 1 kg at a point of a body, shape (n, nv).

    Args:
        body: along the motion.
        p: from the centre of mass, in the body's axes, shape (3,) [m].
    """
    r = body.R @ p
    a = body.a_c + np.cross(body.α, r) + np.cross(body.ω, np.cross(body.ω, r))
    return _on_joints(_jacobian(body, r), a)


def weights(body: MovingBody, p: np.ndarray) -> tuple[np.ndarray, ...]:
    """Returns the forces of 1 N along each axis of the world at a point, three of shape (n, nv).

    Args:
        body: along the motion.
        p: from the centre of mass, in the axes of the inertia, shape (3,) [m].
    """
    J = _jacobian(body, body.R_i @ p)
    return J[:, 0], J[:, 1], J[:, 2]


def _jacobian(body: MovingBody, r: np.ndarray) -> np.ndarray:
    """Returns J(p), shape (n, 3, nv), of the point at r from the centre of mass, shape (n, 3)."""
    return np.asarray(body.J_c + np.cross(body.J_ω, r[:, :, None], axis=1))


def _on_joints(J: np.ndarray, F: np.ndarray) -> np.ndarray:
    return np.asarray(np.einsum("kcj,kc->kj", J, F))
