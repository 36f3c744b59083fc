"""The rate of change of the state along a trajectory, and its derivatives.

    ẋ = f(x, u, θ),    x = (position in tangent space, velocity, activation)

    F = ∂f/∂x,  G = ∂f/∂u        differences of accelerations, means over intervals

The points of a trajectory are many and its means are coarse, so forward differences are enough for
all but velocities, which take secants (`identification.linear.derivatives`).
"""

from __future__ import annotations

import mujoco
import numpy as np

from identification.engine import quiet
from identification.kalman.trajectory import Trajectory
from identification.linear.derivatives import FORWARD, differences, position_rows
from identification.linear.points import Change, Points
from identification.native.forward import Intervals


def state_derivatives(along: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Returns F and G along a trajectory, as means over its intervals.

    Args:
        along: the trajectory.

    Returns:
        F, shape (L, nx, nx), nx = 2 nv + na, and G, shape (L, nx, nu).

    Raises:
        DivergenceError: the accelerations are not finite.
    """
    nv = along.model.nv
    of_state, of_inputs = differences(along, Points(along), FORWARD, along.weighted, along.moved)
    rows = along.average(position_rows(along.model, along.qvel))
    return (
        np.concatenate([rows, of_state], axis=1),
        np.concatenate([np.zeros((len(rows), nv, of_inputs.shape[2])), of_inputs], axis=1),
    )


def input_derivatives(along: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Returns the change of all rates per unit of each input, upwards and downwards, at the points.

    The two differ where an input is at its limit.

    Args:
        along: the trajectory.

    Returns:
        Each of shape (M, nf, nu), nf = nv + na.

    Raises:
        DivergenceError: the accelerations are not finite.
    """
    h, alone = FORWARD.step, Intervals(np.arange(len(along.time)), np.ones(len(along.time)))
    nu = along.inputs.shape[1]
    shifted = (Change({"ctrl": along.inputs + by}) for by in (*h * np.eye(nu), *-h * np.eye(nu)))
    each = [change / h for change in Points(along).each(shifted, alone)]
    if not each:
        nothing = np.zeros((len(along.time), along.model.nv + along.model.na, 0))
        return nothing, nothing
    return np.stack(each[:nu], axis=-1), -np.stack(each[nu:], axis=-1)


@quiet()
def force_derivatives(along: Trajectory, dofs: list[int]) -> np.ndarray:
    """Returns the effect of generalised forces on the rate of the state, shape (M, nx, n)."""
    model = along.model
    nv = model.nv
    data, unit = mujoco.MjData(model), np.eye(nv)[dofs]
    pushed = np.empty_like(unit)
    G = np.zeros((len(along.time), 2 * nv + model.na, len(dofs)))
    for k, (qpos, qvel) in enumerate(zip(along.qpos, along.qvel, strict=True)):
        data.qpos, data.qvel = qpos, qvel
        mujoco.mj_forward(model, data)
        mujoco.mj_solveM(model, data, pushed, unit)
        G[k, nv : 2 * nv] = pushed.T
    return G
