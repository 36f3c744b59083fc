"""Forces on the joints by bodies and tendons that move as a log says, and its smooth motion.

    F = m J_cᵀ a_c + J_ωᵀ (I α + ω × I ω)                       of a body by itself
    F = J(p)ᵀ a(p),    J(p) = J_c - [r]× J_ω,    r = R p        of 1 kg at a point p of it
    a(p) = a_c + α × r + ω × (ω × r)
    F = J(p)ᵀ e                                                 of 1 N along an axis e of the world
    F = J_tᵀ L̇,   J_tᵀ sign L̇,   J_tᵀ k (L - L_0)               of a tendon with damping 1, friction
                                                                1, and its spring

c: centre of mass, ω, α: angular velocity and acceleration, J_c, J_ω: Jacobians, I: inertia in the
axes of the world, R: axes of the body; L: length of a tendon, J_t: its derivatives by the joints.

    q̄ = ψ * q,   v = ψ' * q,   a = ψ'' * q             ψ_i = (1 - (i/w)²)³, scaled to a sum of one
    σ_a = σ |ψ''|                                      noise of a, σ that of q
    σ_τj² = mean_k Σ_i M_ji(q̄_k)² σ_ai²                noise of the forces M a that move the masses

Accelerations come from the weak form, as in Brunot, Janot, Young, Carrillo (2018): every signal is
smoothed by ψ, and q̈ by its second difference, so that noise stays small. In a long chain of bodies
the noises of all accelerations act on the first joint, over the length of the whole chain, while
the accelerations themselves cancel there. So both are compared with what they disturb.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.runtime.engine import quiet
from identification.torques.equations.bodies import MovedBody

NOISE = 0.1  # of an acceleration, or of the force that it needs, that its noise may be
WIDTHS = (2, 4, 8, 16, 32, 64)  # half the length of ψ that are tried, in samples


@dataclass(frozen=True)
class Smooth:
    """Smoothed motion and inputs of the chosen samples."""

    q: np.ndarray  # positions, shape (n, nv) [rad or m]
    v: np.ndarray  # velocities, shape (n, nv)
    a: np.ndarray  # accelerations, shape (n, nv)
    u: np.ndarray  # inputs, shape (n, nu), in their units


def widths(q: np.ndarray, h: float, wider: int = 1) -> Iterator[int]:
    """Yields half the lengths of ψ, in samples, whose accelerations are not those of noise.

    Of positions q (n, nv) every h [s]; ψ must fit into the log also when it is made wider.
    """
    noise = noise_floor(q)
    for w in WIDTHS:
        if 8 * w * wider > len(q):
            return
        _, _, bend = kernels(w, h)
        if (noise * np.linalg.norm(bend) <= NOISE * _filtered(q, bend).std(axis=0)).all():
            yield w


def smoothed(q: np.ndarray, log: Log, w: int, rows: int) -> Smooth:
    """Returns positions q (n, nv) and the inputs through ψ of half the length w, at some rows."""
    u = log.inputs
    held = (np.vstack([u[:1], u[:-1]]) + u) / 2 if log.hold == "zoh" else u
    psi, slope, bend = kernels(w, log.sampling_time)
    parts = [_filtered(q, kernel) for kernel in (psi, slope, bend)]
    every = max(1, len(parts[0]) // max(rows, 1))
    return Smooth(*(part[::every] for part in (*parts, _filtered(held, psi))))


@quiet()
def is_hidden(
    model: mujoco.MjModel, motion: Smooth, q: np.ndarray, w: int, h: float, driven: np.ndarray
) -> bool:
    """Returns whether noise of the positions q (n, nv) hides the forces that move the masses.

    They are compared with the forces M a themselves, and not with those of the drives, so that the
    unit of the positions does not matter. Where no drive acts, they may all cancel.
    """
    noise = noise_floor(q) * np.linalg.norm(kernels(w, h)[2])
    data, M = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    force, variance = np.empty(motion.a.shape), np.zeros(model.nv)
    for k in range(len(force)):
        data.qpos = motion.q[k]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_tendon(model, data)  # tendons have inertias
        mujoco.mj_makeM(model, data)
        mujoco.mj_fullM(model, data, M)
        force[k] = M @ motion.a[k]
        variance += M**2 @ noise**2 / len(force)
    share = np.sqrt(variance) > NOISE * force.std(axis=0)
    return bool(share[driven].any())


def kernels(w: int, h: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns ψ of half the length w, and the kernels of the first and the second derivative."""
    x = np.arange(-w + 1, w) / w
    psi = np.pad((1 - x**2) ** 3, 2)
    psi /= psi.sum()
    return psi[1:-1], (psi[:-2] - psi[2:]) / (2 * h), np.diff(psi, 2) / h**2


def _filtered(signals: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    """Returns Σ_i kernel_i y_{k+i} of columns (n, m), where the kernel fits."""
    if not signals.shape[1]:  # of a free swing: it has samples, and no inputs
        return np.zeros((max(0, len(signals) - len(kernel) + 1), 0))
    return np.stack([np.correlate(y, kernel, "valid") for y in signals.T], axis=1)


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
    """Computes the forces of tendons on the joints of a robot at q and v, all of shape (n, nv).

    These are those of each tendon's damping and friction of one, then those of springs.
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
