"""The frictions of all joints, which every fit of torques has."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from identification.torques.equations.rows import Rows

FRICTION = ("viscous", "coulomb", "offset")


def friction_columns(rows: Sequence[Rows]) -> np.ndarray:
    """Returns columns of viscous and Coulomb friction and offset of joints, (N, nv, 3 nv)."""
    v, sign = (np.concatenate([getattr(r, n) for r in rows]) for n in ("v", "sign"))
    nv = v.shape[1]
    out = np.zeros((len(v), nv, 3 * nv))
    for j in range(nv):
        out[:, j, 3 * j], out[:, j, 3 * j + 1], out[:, j, 3 * j + 2] = v[:, j], sign[:, j], -1.0
    return out


def friction_names(model: mujoco.MjModel) -> tuple[list[str], list[str]]:
    """Returns names and units of the frictions of all joints, as `friction_columns` has them."""
    names, units = [], []
    for j in model.dof_jntid:
        is_slide = int(model.jnt_type[j]) == int(mujoco.mjtJoint.mjJNT_SLIDE)
        f, x = ("N", "m") if is_slide else ("N m", "rad")
        names += [f"{kind} of {model.joint(int(j)).name}" for kind in FRICTION]
        units += [f"{f} s/{x}", f, f]
    return names, units


def read_friction(model: mujoco.MjModel) -> np.ndarray:
    """Returns damping, friction loss and zero of each joint of a model, shape (3 nv,)."""
    none = np.zeros(model.nv)
    return np.stack([model.dof_damping, model.dof_frictionloss, none], axis=1).ravel()
