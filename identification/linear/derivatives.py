"""Derivatives of accelerations, rates of activations and sensors, by differences.

    ẋ = f(x, u),    x = (position in tangent space, velocity, activation)

    ∂f/∂x_i ≈ (f(x + h e_i) - f(x))/h                   forward
    ∂f/∂x_i ≈ (f(x + h e_i) - f(x - h e_i))/2h          central, exact to second order
    ∂f/∂v_i ≈ (f(v + Δ_i e_i/2) - f(v - Δ_i e_i/2))/Δ_i   secant, over how far v_i moves

A friction turns over within a fraction of an interval where its joint turns back. Its slope at one
point says little of the interval; a secant is the exact mean of the slope where the velocity moves
evenly.

The rates of positions need no differences:

    δq̇ = δv                      of a slide or a hinge, and of the position of a free body
    δθ̇ = δω - ω × δθ             of an orientation, in the body's own frame
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.linear.points import AtPoints, Change, Points
from identification.native.forward import Intervals

FREE, BALL = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_BALL)


@dataclass(frozen=True)
class Scheme:
    """The scheme by which a derivative is taken."""

    step: float  # h, in the units of the state and of the inputs
    is_central: bool  # whether both sides are taken


FORWARD = Scheme(1e-7, is_central=False)
# A cable of the stiffest robots here goes slack after some 1e-5 m: the step stays below that.
CENTRAL = Scheme(1e-6, is_central=True)


def differences(
    at: AtPoints,
    points: Points,
    scheme: Scheme,
    intervals: Intervals | None = None,
    moved: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Returns derivatives of the results of `points` with respect to the state and the inputs.

    Their shapes are (L, results, nx), nx = 2 nv + na, and (L, results, nu), for L intervals over
    which forward differences are averaged, or points. Secants are taken where `moved` (M, nv) says
    how far each velocity moves in the time that a point stands for.
    """
    h, nx = scheme.step, 2 * at.model.nv + at.model.na
    if scheme.is_central:
        pairs = zip(points.each(_shifted(at, h)), points.each(_shifted(at, -h)), strict=True)
        each = [(ahead - back) / (2 * h) for ahead, back in pairs]
    else:
        over = intervals or Intervals(np.arange(len(at.time)), np.ones(len(at.time)))
        each = [change / h for change in points.each(_shifted(at, h, moved), over)]
        if moved is not None:
            nv = at.model.nv
            sides = each[nv : 3 * nv]
            each[nv : 3 * nv] = [a + b for a, b in zip(sides[::2], sides[1::2], strict=True)]
    of_state, of_inputs = np.stack(each[:nx], axis=-1), each[nx:]
    if not of_inputs:
        return of_state, np.zeros((*of_state.shape[:-1], 0))
    return of_state, np.stack(of_inputs, axis=-1)


def _shifted(at: AtPoints, by: float, moved: np.ndarray | None = None) -> Iterator[Change]:
    """Yields the changes that shift the states and the inputs one after the other."""
    for i in range(at.model.nv):
        yield Change({"qpos": shift_position(at.model, at.qpos, i, by)})
    if moved is None:
        yield from _each_shifted("qvel", at.qvel, by)
    else:
        yield from _secants(at, by, moved)
    yield from _each_shifted("act", at.act, by)
    yield from _each_shifted("ctrl", at.inputs, by)


def _each_shifted(field: str, value: np.ndarray, by: float) -> Iterator[Change]:
    """Yields the changes that shift the columns of a field one after the other."""
    for unit in np.eye(value.shape[1]):
        yield Change({field: value + by * unit})


def _secants(at: AtPoints, by: float, moved: np.ndarray) -> Iterator[Change]:
    """Yields both ends of each velocity's way, whose results add up to `by` times the secant."""
    for i, way in enumerate(moved.T):
        way = np.where(np.abs(way) > by, way, by)
        for end in (0.5, -0.5):
            qvel = at.qvel.copy()
            qvel[:, i] += end * way
            yield Change({"qvel": qvel}, courses=(by / (2 * end) / way)[None])


def position_rows(model: mujoco.MjModel, qvel: np.ndarray) -> np.ndarray:
    """Returns the rows of ∂ẋ/∂x that belong to positions, (M, nv, nx), at velocities (M, nv)."""
    nv = model.nv
    rows = np.zeros((len(qvel), nv, 2 * nv + model.na))
    rows[:, np.arange(nv), nv + np.arange(nv)] = 1
    for joint, kind in enumerate(model.jnt_type):
        if kind in (FREE, BALL):
            i = int(model.jnt_dofadr[joint]) + (3 if kind == FREE else 0)
            ω = qvel[:, i : i + 3]
            rows[:, i : i + 3, i : i + 3] = np.cross(np.eye(3), ω[:, None]).swapaxes(1, 2)
    return rows


def shift_position(model: mujoco.MjModel, qpos: np.ndarray, dof: int, by: float) -> np.ndarray:
    """Returns positions (M, nq) after a small shift [m or rad] of one degree of freedom."""
    joint = int(model.dof_jntid[dof])
    kind, place = model.jnt_type[joint], dof - int(model.jnt_dofadr[joint])
    at = int(model.jnt_qposadr[joint])
    out = qpos.copy()
    if kind == BALL or (kind == FREE and place >= 3):
        at, axis = at + (3 if kind == FREE else 0), place - (3 if kind == FREE else 0)
        out[:, at : at + 4] = _turned(qpos[:, at : at + 4], by * np.eye(3)[axis])
    else:
        out[:, at + place] += by
    return out


def _turned(quaternion: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Returns quaternions (M, 4) after a small rotation in the body's frame, angle (3,) [rad]."""
    w, v = quaternion[:, :1], quaternion[:, 1:]
    half = angle / 2
    return np.concatenate([w - v @ half[:, None], v + w * half + np.cross(v, half)], axis=1)
