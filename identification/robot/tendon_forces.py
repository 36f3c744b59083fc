"""Forces on the joints by tendons that a motion of the joints stretches, all samples at once.

    F = J_tᵀ L̇,   J_tᵀ sign L̇,   J_tᵀ k (L - L_0)    of damping 1, friction 1, and a spring

L: length of a tendon, J_t: its derivatives by the joints. Each is what a drive has to bring.
"""

from __future__ import annotations

import copy

import mujoco
import numpy as np

from identification.engine import quiet

PASSIVE = (  # parts of MuJoCo's step that a model may leave out, and that are needed here
    mujoco.mjtDisableBit.mjDSBL_SPRING,
    mujoco.mjtDisableBit.mjDSBL_DAMPER,
)


@quiet()
def tendon_forces(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Computes the forces that tendons put on the joints of a moving robot.

    Args:
        model: of the robot.
        q: positions, shape (n, nv) [rad or m].
        v: velocities, shape (n, nv).

    Returns:
        Forces of each tendon's damping and friction of one, and those of its own spring where it
        has one, each of shape (n, nv).
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
