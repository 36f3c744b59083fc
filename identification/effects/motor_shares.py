"""The inertia that drives feel, and how much of it their motors may have.

    I_j = min 1/A_jj,   A = M⁻¹                      over several poses, of the model's file
    λ_max(√J A √J) < 1                               in each of them, J: of all motors at once

The links of a robot keep M - J. For one motor that is positive where J < I; several may together
ask for more than there is.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from identification.engine import quiet
from identification.errors import DivergenceError
from identification.logs.names import listed

POSES = 8  # random ones, behind the model's own


@quiet()
def mobilities(model: mujoco.MjModel, joints: Sequence[str]) -> np.ndarray:
    """Returns A among some joints in several poses, shape (`POSES`, g, g) [1/kg or 1/(kg m²)]."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    dofs = [int(model.joint(joint).dofadr[0]) for joint in joints]
    units, columns = np.zeros((len(dofs), model.nv)), np.zeros((len(dofs), model.nv))
    units[range(len(dofs)), dofs] = 1.0
    out = np.empty((POSES, len(dofs), len(dofs)))
    for pose in out:
        mujoco.mj_forward(model, data)
        if dofs:
            mujoco.mj_solveM(model, data, columns, units)
        pose[:] = columns[:, dofs]
        mujoco.mj_integratePos(model, data.qpos, rng.normal(0, 1, model.nv), 1.0)
    return out


def felt_inertias(A: np.ndarray) -> np.ndarray:
    """Returns I of each joint, shape (g,) [kg m² or kg], from A of `mobilities`."""
    return np.asarray(1 / np.max(np.diagonal(A, axis1=1, axis2=2), axis=0))


def refuse_greedy(J: np.ndarray, A: np.ndarray, joints: Sequence[str]) -> None:
    """Refuse motors that leave less than nothing to the links.

    Args:
        J: inertias of the motors that move by themselves, else 0, in n value sets, shape (n, g).
        A: of `mobilities`.
        joints: their names.

    Raises:
        DivergenceError: a value set has such motors.
    """
    J = J[np.count_nonzero(J, axis=1) > 1]
    if not len(J):
        return
    root = np.sqrt(J)[:, None]
    share = np.linalg.eigvalsh(root[..., None] * A * root[..., None, :])[..., -1]
    if np.any(share >= 1):
        raise DivergenceError(
            f"the motors of {listed(joints)} would have more inertia than the robot has; take a"
            " smaller share rho"
        )
