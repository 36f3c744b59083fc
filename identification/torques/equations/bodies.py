"""Bodies along a motion, and the forces on the joints that each of their ten numbers needs.

    τ = Y(q, q̇, q̈) π,   π_b = (m, h, I_O)                 h = m c, I_O about the frame's origin
    F = m a + A h,   N = h × a + I_O α + ω × I_O ω          A = [α]× + [ω]×[ω]×,  a: with -g
    Y_b = J_vᵀ ∂F/∂π + J_ωᵀ ∂N/∂π

in the axes of the body: J_v, J_ω: Jacobians of the frame's origin and of the rotation (Atkeson, An,
Hollerbach 1986). Bodies that are welded together are one body. What MuJoCo's inverse dynamics has
beside Y π, such as springs and the armatures of tendons, is not lost:
`identification.torques.equations.rows` takes it from `mj_inverse`.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.effects.plant.body_numbers import about, frame_inertia

NUMBERS = ("m", "h_x", "h_y", "h_z", "I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
UNITS = ("kg", *["kg m"] * 3, *["kg m^2"] * 6)
SIX = ([0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2])  # rows and columns of the six of an inertia matrix
SIX = ([0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2])  # rows and columns of the six of an inertia matrix


@dataclass(frozen=True)
class MovedBody:
    """One body at n samples, in the axes of the world."""

    J_c: np.ndarray  # of its centre of mass, shape (n, 3, nv)
    J_ω: np.ndarray  # of its rotation, shape (n, 3, nv)
    a_c: np.ndarray  # acceleration of its centre of mass, without gravity, shape (n, 3) [m/s^2]
    ω: np.ndarray  # angular velocity, shape (n, 3) [rad/s]
    α: np.ndarray  # angular acceleration, shape (n, 3) [rad/s^2]
    R: np.ndarray  # its axes, shape (n, 3, 3)
    R_i: np.ndarray  # axes of its inertia, shape (n, 3, 3)


def follow_bodies(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray, a: np.ndarray, bodies: Sequence[int]
) -> dict[int, MovedBody]:
    """Returns bodies of a robot of hinges and slides along a motion q, v, a of shape (n, nv)."""
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
        b: MovedBody(
            J_c=J[i, 0], J_ω=J[i, 1], a_c=acceleration[i, :, 3:], α=acceleration[i, :, :3],
            ω=np.einsum("kcj,kj->kc", J[i, 1], v),
            R=axes[i, 0].reshape(n, 3, 3), R_i=axes[i, 1].reshape(n, 3, 3),
        )
        for i, b in enumerate(bodies)
    }  # fmt: skip


def list_bodies(model: mujoco.MjModel) -> tuple[int, ...]:
    """Returns the bodies that joints move, one of each group that is welded together."""
    return tuple(b for b in range(1, model.nbody) if model.body_weldid[b] == b)


def label_of(model: mujoco.MjModel, body: int) -> str:
    """Returns the name of a body, that of its first joint, or its number."""
    first = int(model.body_jntadr[body])
    return model.body(body).name or model.joint(first).name or f"{body}"


def read_numbers(model: mujoco.MjModel) -> np.ndarray:
    """Returns π of a model's moving bodies with what is welded to them, shape (bodies, 10)."""
    data, bodies = mujoco.MjData(model), list_bodies(model)
    mujoco.mj_kinematics(model, data)
    out = np.zeros((len(bodies), 10))
    for i, root in enumerate(bodies):
        R_0, x_0 = data.xmat[root].reshape(3, 3), data.xpos[root]
        for b in np.flatnonzero(model.body_weldid == root):
            m, c = float(model.body_mass[b]), R_0.T @ (data.xipos[b] - x_0)
            R = R_0.T @ data.xmat[b].reshape(3, 3)
            I_c = R @ frame_inertia(model.body_inertia[b], model.body_iquat[b]) @ R.T
            I_O = I_c + about(m, c)
            out[i] += [m, *(m * c), *I_O[SIX]]
    return out


def regressor(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray, a: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns Y (n, nv, bodies, 10) along a motion (n, nv), and gravity's forces on the joints.

    The forces, shape (n, nv) [N m or N], are those of the model's own masses.
    """
    bodies = list_bodies(model)
    gravity, numbers = np.array(model.opt.gravity), read_numbers(model)
    Y, weight = np.empty((*q.shape, len(bodies), 10)), np.zeros(q.shape)
    for i, (b, moved) in enumerate(follow_bodies(model, q, v, a, bodies).items()):
        r = -moved.R @ model.body_ipos[b]  # from the centre of mass to the frame's origin
        J_o = moved.J_c + np.cross(moved.J_ω, r[:, :, None], axis=1)
        a_o = moved.a_c + np.cross(moved.α, r) + np.cross(moved.ω, np.cross(moved.ω, r))
        turn = np.swapaxes(moved.R, 1, 2)
        J_v, J_w = turn @ J_o, turn @ moved.J_ω
        ω, α, a = (np.einsum("kij,kj->ki", turn, x) for x in (moved.ω, moved.α, a_o))
        g = np.einsum("kij,j->ki", turn, gravity)
        Y[:, :, i] = _columns(J_v, J_w, a - g, ω, α)
        none = np.zeros_like(ω)
        weight -= _columns(J_v, J_w, -g, none, none) @ numbers[i]
    return Y, weight


def _columns(
    J_v: np.ndarray, J_w: np.ndarray, a: np.ndarray, ω: np.ndarray, α: np.ndarray
) -> np.ndarray:
    """Returns Y of one body, shape (n, nv, 10), in its own axes."""
    A = _cross(α) + _cross(ω) @ _cross(ω)
    E = _spread(α) + _cross(ω) @ _spread(ω)
    up_v, up_w = np.swapaxes(J_v, 1, 2), np.swapaxes(J_w, 1, 2)
    return np.concatenate([up_v @ a[:, :, None], up_v @ A - up_w @ _cross(a), up_w @ E], axis=2)


def _cross(x: np.ndarray) -> np.ndarray:
    """Returns [x]×, shape (n, 3, 3)."""
    return np.swapaxes(np.cross(x[:, None], np.eye(3)), 1, 2)


def _spread(x: np.ndarray) -> np.ndarray:
    """Returns L(x) with L(x) (I_xx, I_yy, I_zz, I_xy, I_xz, I_yz) = I x, shape (n, 3, 6)."""
    out = np.zeros((len(x), 3, 6))
    for row, places in enumerate(((0, 3, 4), (3, 1, 5), (4, 5, 2))):  # of I's rows in the six
        out[:, row, places] = x
    return out
