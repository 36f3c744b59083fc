"""Free parameters of a robot's file that change no inertial number, such as a spring or a gain.

    y(θ) = y(θ_0) + (θ - θ_0) dy/dθ         by the equations of a model that has θ moved
    gains: dy/dθ = a_j (τ̂_u)_j, beside frictions        a_j: share of joint j

A gain of a drive scales its force, so that a drive without a gain and an arm without masses leave
nothing at all. With the forces that a fit predicts in the place of the measured ones, what is left
stays in units of the drives as the model has them, and is the same for any multiple of all numbers:
the scale is told by what is held, and by what was known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import compress

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.torques.equations.equations import Equations
from identification.torques.equations.frictions import friction_columns
from identification.torques.equations.rows import Rows, make_rows

ALMOST = 1e-3  # share of a column that a sum may miss: a servo's own rate is of a wider band


@dataclass(frozen=True, kw_only=True)
class FreeNumber:
    """A free parameter of the robot's file that changes what the equations say."""

    name: str  # as in the file
    where: str  # path in the model
    unit: str  # SI unit
    value: float  # of the model
    mean: float  # what was known
    std: float  # of what was known
    # of (bodies · 10 numbers, armatures) with it, shape (n,); zero where it changes none
    change: np.ndarray
    # the model in which it is larger by `step`, where it changes no inertial number
    moved: mujoco.MjModel | None = None
    step: float = 0.0  # see `moved`


@dataclass(frozen=True, kw_only=True)
class Others:
    """Free parameters that change no inertial number, k of them, with their columns."""

    free: tuple[FreeNumber, ...]
    columns: np.ndarray  # -dy/dθ, shape (N, nv, k)
    # of each: what share of the joints' forces it scales, shape (k, nv); zero of what is no gain
    shares: np.ndarray
    held: np.ndarray  # part of the right side of numbers that are held at their mean, shape (N, nv)
    rows: tuple[tuple[Rows, ...], ...]  # of the models that have them moved

    @classmethod
    def of(
        cls, free: Sequence[FreeNumber], equations: Equations, logs: Sequence[Log],
        wider: float = 1.0,
    ) -> Others:  # fmt: skip
        """Returns those of all free parameters, by the equations of models that have them moved.

        The equations of these logs were made with bands that were `wider` by this factor.
        """
        some = [(f, make_rows(f.moved, logs, wider=wider)) for f in free if f.moved is not None]
        return cls._of_rows(tuple(f for f, _ in some), tuple(r for _, r in some), equations)

    @classmethod
    def _of_rows(
        cls, free: tuple[FreeNumber, ...], rows: tuple[tuple[Rows, ...], ...], equations: Equations
    ) -> Others:
        y, columns = equations.stacked("y"), [np.zeros((*equations.stacked("y").shape, 0))]
        for f, of in zip(free, rows, strict=True):
            moved = [m.shifted(r.shift).y for m, r in zip(of, equations.rows, strict=True)]
            columns.append((y - np.concatenate(moved))[:, :, None] / f.step)
        every = np.concatenate(columns, axis=2)
        each = [_share(c, equations) for c in np.moveaxis(every, 2, 0)]
        shares = np.array(each).reshape(len(free), equations.joints)
        return cls(free=free, columns=every, shares=shares, held=np.zeros_like(y), rows=rows)

    @property
    def gains(self) -> np.ndarray:
        """Whether each is a gain of drives, shape (k,)."""
        return np.asarray(self.shares.any(axis=1))

    def expecting(self, off: np.ndarray) -> Others:
        """Returns these with gains of forces that are another by `off` (N, nv) [N m or N]."""
        return replace(self, columns=self.columns + off[:, :, None] * self.shares.T)

    def at(self, equations: Equations) -> Others:
        """Returns these where the inputs have other times."""
        return self._of_rows(self.free, self.rows, equations)

    def without_gains(self) -> Others:
        """Returns these but for the gains, which are held at their means."""
        keep, off = ~self.gains, np.array([f.value - f.mean for f in self.free])
        held = self.columns @ np.where(self.gains, off, 0.0)
        return Others(
            free=tuple(compress(self.free, keep)), rows=tuple(compress(self.rows, keep)),
            columns=self.columns[:, :, keep], shares=self.shares[keep], held=self.held + held,
        )  # fmt: skip

    @property
    def start(self) -> np.ndarray:
        """Their part of the right side at the values of the model, shape (N, nv)."""
        return np.asarray(self.columns @ np.array([f.value for f in self.free]) + self.held)


def _share(column: np.ndarray, equations: Equations) -> np.ndarray:
    """Returns what multiple of each joint's force a column (N, nv) has, shape (nv,).

    Zero where the column is no sum of drives' forces and of frictions, which are free in all fits:
    kp of a servo with a damping scales its force but for that.
    """
    drives, friction = equations.stacked("drives"), friction_columns(equations.rows)
    out = np.zeros(equations.joints)
    for j, of_joint in enumerate(column.T):
        acts = drives[:, j].any(axis=0)
        X = np.hstack([drives[:, j, acts], friction[:, j, 3 * j : 3 * j + 3]])
        size = np.maximum(np.linalg.norm(X, axis=0), np.finfo(float).tiny)
        factors = np.linalg.lstsq(X / size, of_joint, rcond=None)[0]
        if np.linalg.norm(of_joint - X / size @ factors) > ALMOST * np.linalg.norm(of_joint):
            return np.zeros(equations.joints)
        of_drives = factors[: acts.sum()]
        if np.linalg.norm(of_drives) > ALMOST * np.linalg.norm(of_joint):
            out[j] = np.mean(of_drives / size[: acts.sum()])
    return out
