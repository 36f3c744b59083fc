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
from identification.linear.points import Points


def state_derivatives(along: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """F and G along a trajectory, means over its intervals.

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


@quiet()
def force_derivatives(along: Trajectory, dofs: list[int]) -> np.ndarray:
    """The effect of generalised forces on the rate of change of the state, shape (M, nx, n)."""
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
