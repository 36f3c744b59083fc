"""Joints that equalities between joints tie to others, such as the joint behind a belt.

    q_1 - q_1(0) = p(q_2 - q_2(0)),   p(x) = c_0 + c_1 x + ... + c_4 x⁴,   q(0) of the model's file

Where one of the two is known, so is the other, with its rate: q_1 from any p, q_2 from a straight
one (c_2 = c_3 = c_4 = 0). A simulation that began elsewhere would begin with a force that no robot
has, because MuJoCo holds an equality by a stiff spring.
"""

from __future__ import annotations

from collections.abc import Collection

import mujoco
import numpy as np
from numpy.polynomial import polynomial

_JOINT = int(mujoco.mjtEq.mjEQ_JOINT)
_SCALAR = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))


def tied_joints(model: mujoco.MjModel, known: Collection[int]) -> list[tuple[int, int, np.ndarray]]:
    """Returns the joints that known ones tell, in an order in which each follows from the others.

    Args:
        model: with its equalities.
        known: numbers of the joints whose positions are known.

    Returns:
        For each its number, that of the joint that tells it, and the coefficients of p, from c_0
        on, with which its position follows.
    """
    ties = [tie for e in np.flatnonzero(model.eq_type == _JOINT) for tie in _ways(model, int(e))]
    told, out = {*known}, []
    while found := next((t for t in ties if t[1] in told and t[0] not in told), None):
        told.add(found[0])
        out.append(found)
    return out


def put_tied(
    model: mujoco.MjModel, known: Collection[int], qpos: np.ndarray, qvel: np.ndarray
) -> None:
    """Write the positions and rates of tied joints into states, from those of the known joints.

    Args:
        model: with its equalities.
        known: numbers of the joints whose positions are known.
        qpos: positions, shape (nq,) or (n, nq) [m or rad]; those of tied joints are replaced.
        qvel: rates, shape (nv,) or (n, nv) [m/s or rad/s]; those of tied joints are replaced.
    """
    for joint, leader, p in tied_joints(model, known):
        to, of = (int(model.jnt_qposadr[j]) for j in (joint, leader))
        x = qpos[..., of] - model.qpos0[of]
        qpos[..., to] = model.qpos0[to] + polynomial.polyval(x, p)
        slope = polynomial.polyval(x, polynomial.polyder(p))
        qvel[..., model.jnt_dofadr[joint]] = slope * qvel[..., model.jnt_dofadr[leader]]


def _ways(model: mujoco.MjModel, e: int) -> list[tuple[int, int, np.ndarray]]:
    """Returns in which ways the joints of an equality tell each other, as `tied_joints` does."""
    one, other = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    if other < 0 or not model.eq_active0[e]:
        return []
    if any(int(model.jnt_type[j]) not in _SCALAR for j in (one, other)):
        return []
    p = np.array(model.eq_data[e, :5])
    ways = [(one, other, p)]
    if p[1] and not p[2:].any():
        ways.append((other, one, np.array([-p[0] / p[1], 1 / p[1]])))
    return ways
