"""Forces on the joints by bodies and tendons that move as a log says, all samples at once.

    F = m J_cᵀ a_c + J_ωᵀ (I α + ω × I ω)                       of a body by itself
    F = J(p)ᵀ a(p),    J(p) = J_c - [r]× J_ω,    r = R p        of 1 kg at a point p of it
    a(p) = a_c + α × r + ω × (ω × r)
    F = J(p)ᵀ e                                                 of 1 N along an axis e of the world
    F = J_tᵀ L̇,   J_tᵀ sign L̇,   J_tᵀ k (L - L_0)               of a tendon with damping 1, friction
                                                                1, and its spring

c: centre of mass, ω, α: angular velocity and acceleration, J_c, J_ω: Jacobians, I: inertia in the
axes of the world, R: axes of the body; L: length of a tendon, J_t: its derivatives by the joints.
"""

from __future__ import annotations

import copy

import mujoco
import numpy as np

from identification.engine import quiet
from identification.torques.bodies import MovedBody

PASSIVE = (  # parts of MuJoCo's step that a model may leave out, and that are needed here
    mujoco.mjtDisableBit.mjDSBL_SPRING,
    mujoco.mjtDisableBit.mjDSBL_DAMPER,
)


def inertial_force(body: MovedBody, mass: float, inertia: np.ndarray) -> np.ndarray:
    """Returns the forces (n, nv) that move a body with a mass [kg] and inertias (3,) [kg m^2]."""
    In = body.R_i @ (inertia[:, None] * np.swapaxes(body.R_i, 1, 2))
    turned, twisted = (np.einsum("kij,kj->ki", In, x) for x in (body.ω, body.α))
    torque = twisted + np.cross(body.ω, turned)
    return mass * _on_joints(body.J_c, body.a_c) + _on_joints(body.J_ω, torque)


def point_force(body: MovedBody, p: np.ndarray) -> np.ndarray:
    """Returns the forces (n, nv) that move 1 kg at p [m] from the centre of mass, in body axes."""
    r = body.R @ p
    a = body.a_c + np.cross(body.α, r) + np.cross(body.ω, np.cross(body.ω, r))
    return _on_joints(_jacobian(body, r), a)


def weights(body: MovedBody, p: np.ndarray) -> tuple[np.ndarray, ...]:
    """Returns the forces (n, nv) of 1 N along each axis of the world at p [m] in inertia axes."""
    J = _jacobian(body, body.R_i @ p)
    return J[:, 0], J[:, 1], J[:, 2]


@quiet()
def tendon_forces(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Computes the forces of tendons on the joints of a robot at q, v of shape (n, nv).

    Returns:
        Forces of each tendon's damping and friction of one, and those of its spring where it has
        one, each of shape (n, nv).
    """
    alone, data = copy.copy(model), mujoco.MjData(model)
    alone.opt.disableflags &= ~sum(int(bit) for bit in PASSIVE)
    alone.dof_damping[:], alone.jnt_stiffness[:] = 0.0, 0.0
    resisting, springs = [], []
    for i in range(model.ntendon):
        stiffness = float(model.tendon_stiffness[i])
        alone.tendon_damping[:], alone.tendon_stiffness[:] = 0.0, 0.0
        alone.tendon_damping[i], alone.tendon_stiffness[i] = 1.0, stiffness
        damped, held, rate = np.zeros_like(v), np.zeros_like(v), np.zeros(len(v))
        for k in range(len(q)):
            data.qpos, data.qvel = q[k], v[k]
            mujoco.mj_fwdPosition(alone, data)
            mujoco.mj_fwdVelocity(alone, data)
            damped[k], held[k] = -data.qfrc_damper, -data.qfrc_spring
            rate[k] = abs(data.ten_velocity[i])
        moves = np.where(rate > 0, rate, 1.0)[:, None]
        resisting += [damped, damped / moves]
        springs += [held] if stiffness else []
    return resisting, springs


def _jacobian(body: MovedBody, r: np.ndarray) -> np.ndarray:
    """Returns J(p), shape (n, 3, nv), of the point at r from the centre of mass, shape (n, 3)."""
    return np.asarray(body.J_c + np.cross(body.J_ω, r[:, :, None], axis=1))


def _on_joints(J: np.ndarray, F: np.ndarray) -> np.ndarray:
    return np.asarray(np.einsum("kcj,kc->kj", J, F))
