"""The rate of change of the state along a trajectory, and its derivatives.

    ẋ = f(x, u, θ),    x = (position in tangent space, velocity, activation)

    F = ∂f/∂x,  G = ∂f/∂u        differences of accelerations; the rates of positions are exact:
    δq̇ = δv                      of a slide or a hinge, and of the position of a free body
    δθ̇ = δω - ω × δθ             of an orientation, in the body's own frame

All points of a trajectory are one batch.
"""

from __future__ import annotations

import mujoco
import numpy as np
from mujoco.batch import Batch

from identification.errors import DivergenceError
from identification.kalman.trajectory import Trajectory
from identification.model.rollout import threads

EPS = 1e-7  # of the differences, in the units of the state and of the inputs
FREE, BALL = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_BALL)


class Points:
    """The points of a trajectory, at which one model is evaluated many times.

    Args:
        along: the trajectory.
        model: with other numbers; the trajectory's own when None.
    """

    def __init__(self, along: Trajectory, model: mujoco.MjModel | None = None) -> None:
        self._along = along
        self._batch = Batch(model or along.model, len(along.time), threads())
        self._batch.bind("time")[:] = along.time
        self._results = [self._batch.bind("qacc"), *self._activations()]
        self._reset()

    def _activations(self) -> list[np.ndarray]:
        return [self._batch.bind("act_dot")] if self._along.act.shape[1] else []

    def _reset(self) -> None:
        for field in ("qpos", "qvel", "act"):
            if (value := getattr(self._along, field)).shape[1]:
                self._batch.bind(field)[:] = value
        if self._along.inputs.shape[1]:
            self._batch.bind("ctrl")[:] = self._along.inputs

    def rates(self, **changed: np.ndarray) -> np.ndarray:
        """Accelerations and rates of activations, shape (M, nv + na).

        Args:
            changed: values of `qpos`, `qvel`, `act` or `ctrl` that differ from the trajectory's.

        Raises:
            DivergenceError: they are not finite.
        """
        for field, value in changed.items():
            self._batch.bind(field)[:] = value
        self._batch.forward()
        out = np.concatenate(self._results, axis=1)
        if changed:
            self._reset()
        if not np.isfinite(out).all():
            raise DivergenceError(
                "the accelerations along the trajectory are not finite; use values nearer to the"
                " nominal ones"
            )
        return out


def state_derivatives(along: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """F and G along a trajectory, means over its intervals.

    Args:
        along: the trajectory.

    Returns:
        F, shape (L, nx, nx), nx = 2 nv + na, and G, shape (L, nx, nu).

    Raises:
        DivergenceError: the accelerations are not finite.
    """
    model, at = along.model, Points(along)
    nv, na, nu, L = model.nv, model.na, along.inputs.shape[1], len(along.begins)
    f = at.rates()

    def difference(**changed: np.ndarray) -> np.ndarray:
        return along.average((at.rates(**changed) - f) / EPS)

    F, G = np.zeros((L, 2 * nv + na, 2 * nv + na)), np.zeros((L, 2 * nv + na, nu))
    F[:, :nv] = along.average(_of_positions(model, along.qvel))
    for i in range(nv):
        F[:, nv:, i] = difference(qpos=shift_position(model, along.qpos, i, EPS))
        F[:, nv:, nv + i] = difference(qvel=along.qvel + EPS * np.eye(nv)[i])
    for i in range(na):
        F[:, nv:, 2 * nv + i] = difference(act=along.act + EPS * np.eye(na)[i])
    for i in range(nu):
        G[:, nv:, i] = difference(ctrl=along.inputs + EPS * np.eye(nu)[i])
    return F, G


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


def _of_positions(model: mujoco.MjModel, qvel: np.ndarray) -> np.ndarray:
    """The rows of F that belong to positions, shape (M, nv, nx)."""
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
    """Positions after a small shift of one degree of freedom.

    Args:
        model: whose degrees of freedom these are.
        qpos: shape (M, nq).
        dof: index of the degree of freedom.
        by: how far [m or rad].
    """
    joint = int(model.dof_jntid[dof])
    kind, own = model.jnt_type[joint], dof - int(model.jnt_dofadr[joint])
    at = int(model.jnt_qposadr[joint])
    out = qpos.copy()
    if kind == BALL or (kind == FREE and own >= 3):
        at, axis = at + (3 if kind == FREE else 0), own - (3 if kind == FREE else 0)
        out[:, at : at + 4] = _turned(qpos[:, at : at + 4], by * np.eye(3)[axis])
    else:
        out[:, at + own] += by
    return out


def _turned(quaternion: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Quaternions (M, 4) after a small rotation in the body's own frame, angle (3,) [rad]."""
    w, v = quaternion[:, :1], quaternion[:, 1:]
    half = angle / 2
    return np.concatenate([w - v @ half[:, None], v + w * half + np.cross(v, half)], axis=1)
