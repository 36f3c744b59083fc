"""Derivatives of accelerations, rates of activations and sensors, by differences.

    ẋ = f(x, u),    x = (position in tangent space, velocity, activation)

    ∂f/∂x_i ≈ (f(x + h e_i) - f(x))/h                   forward
    ∂f/∂x_i ≈ (f(x + h e_i) - f(x - h e_i))/2h          central, exact to second order

The rates of positions need no differences:

    δq̇ = δv                      of a slide or a hinge, and of the position of a free body
    δθ̇ = δω - ω × δθ             of an orientation, in the body's own frame

All points are one batch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import mujoco
import numpy as np
from mujoco.batch import Batch

from identification.engine import quiet, untimed
from identification.errors import DivergenceError
from identification.model.rollout import threads

FREE, BALL = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_BALL)
RATES = ("qacc", "act_dot")


@dataclass(frozen=True)
class Scheme:
    """How a derivative is taken.

    Attributes:
        step: h, in the units of the state and of the inputs.
        is_central: whether both sides are taken.
    """

    step: float
    is_central: bool


FORWARD = Scheme(1e-7, is_central=False)
# A cable of the stiffest robots here goes slack after some 1e-5 m: the step stays below that.
CENTRAL = Scheme(1e-6, is_central=True)


class AtPoints(Protocol):
    """M states of one model, each array with M rows."""

    @property
    def model(self) -> mujoco.MjModel:
        """The model."""

    @property
    def qpos(self) -> np.ndarray:
        """Positions, shape (M, nq)."""

    @property
    def qvel(self) -> np.ndarray:
        """Velocities, shape (M, nv)."""

    @property
    def act(self) -> np.ndarray:
        """Activations, shape (M, na)."""

    @property
    def inputs(self) -> np.ndarray:
        """Inputs that reach the model, shape (M, nu)."""

    @property
    def time(self) -> np.ndarray:
        """Of the points [s], shape (M,)."""


class Points:
    """States at which one model is evaluated many times.

    Args:
        at: the states.
        model: with other numbers; that of the states when None.
        results: fields of MjData that are returned side by side.
    """

    def __init__(
        self,
        at: AtPoints,
        model: mujoco.MjModel | None = None,
        results: Sequence[str] = RATES,
    ) -> None:
        self._at = at
        self._batch = Batch(model or at.model, len(at.time), min(threads(), len(at.time)))
        self._batch.bind("time")[:] = at.time
        own = (model or at.model).na, (model or at.model).nsensordata
        empty = {"act_dot": own[0] == 0, "sensordata": own[1] == 0}
        self._results = [self._batch.bind(f) for f in results if not empty.get(f, False)]
        self._reset()

    def _reset(self) -> None:
        for field in ("qpos", "qvel", "act"):
            if (value := getattr(self._at, field)).shape[1]:
                self._batch.bind(field)[:] = value
        if self._at.inputs.shape[1]:
            self._batch.bind("ctrl")[:] = self._at.inputs

    def rates(self, **changed: np.ndarray) -> np.ndarray:
        """The results, by default accelerations and rates of activations, shape (M, nv + na).

        Args:
            changed: values of `qpos`, `qvel`, `act` or `ctrl` that differ from the states' own.

        Raises:
            DivergenceError: they are not finite.
        """
        for field, value in changed.items():
            self._batch.bind(field)[:] = value
        with quiet(), untimed():
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


def differences(
    at: AtPoints,
    points: Points,
    scheme: Scheme,
    mean: Callable[[np.ndarray], np.ndarray] = lambda each: each,
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the results of `points` with respect to the state and the inputs.

    Args:
        at: the states.
        points: evaluates the model there.
        scheme: how differences are taken.
        mean: from values at the points to what is kept of them, such as means over intervals.

    Returns:
        With respect to the state, shape (L, results, nx), nx = 2 nv + na, and to the inputs, shape
        (L, results, nu); L points are left by `mean`.

    Raises:
        DivergenceError: the results are not finite.
    """
    model, h = at.model, scheme.step
    nv, na, nu = model.nv, model.na, at.inputs.shape[1]
    f = None if scheme.is_central else points.rates()

    def difference(moved: Callable[[float], dict[str, np.ndarray]]) -> np.ndarray:
        ahead = points.rates(**moved(h))
        if f is None:
            return mean((ahead - points.rates(**moved(-h))) / (2 * h))
        return mean((ahead - f) / h)

    def shifted(field: str, value: np.ndarray, i: int) -> np.ndarray:
        return difference(lambda by: {field: value + by * np.eye(value.shape[1])[i]})

    def turned(i: int) -> np.ndarray:
        return difference(lambda by: {"qpos": shift_position(model, at.qpos, i, by)})

    of_state = [turned(i) for i in range(nv)]
    of_state += [shifted("qvel", at.qvel, i) for i in range(nv)]
    of_state += [shifted("act", at.act, i) for i in range(na)]
    of_inputs = [shifted("ctrl", at.inputs, i) for i in range(nu)]
    if not nu:
        return np.stack(of_state, axis=-1), np.zeros((*of_state[0].shape, 0))
    return np.stack(of_state, axis=-1), np.stack(of_inputs, axis=-1)


def position_rows(model: mujoco.MjModel, qvel: np.ndarray) -> np.ndarray:
    """The rows of ∂ẋ/∂x that belong to positions, shape (M, nv, nx).

    Args:
        model: the model.
        qvel: velocities, shape (M, nv).
    """
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
