"""The fits of torques: with all inertial numbers free, and with those of the robot's file.

    base fit     every inertial number and every friction is free, up to the size of the whole arm
    model fit    the model's numbers are held but those of the robot's file, with their priors;
                 friction is free
    others       free parameters of the file that change no inertial number, such as a spring's
                 stiffness or a drive's gain, are in both: y(θ) = y(θ_0) + (θ - θ_0) dy/dθ
    clock        in both, one shift of the inputs against the outputs, a nuisance: dτ̂_u/dt
    gains        free gains of drives are fitted where the model's masses tell them, in the model
                 fit without effects; elsewhere they are held, because a drive without a gain that
                 moves an arm without masses leaves no residual at all

The base fit says how well a rigid arm with friction can do at all, and needs nothing of the model
but its geometry. The model fit is where a payload can be told from the masses that are known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.effects.inputs import SHIFT
from identification.logs.log import Log
from identification.torques.base import BaseParameters, all_columns, known_numbers
from identification.torques.candidates import rate_of
from identification.torques.equations import (
    Equations,
    Estimate,
    estimate,
    list_passive,
    model_forces,
)
from identification.torques.laws import Missing
from identification.torques.moments import Base, Weighted, held_by
from identification.torques.rows import Rows, make_rows

FRICTION = ("viscous", "coulomb", "offset")
CLOCK = "clock of the inputs"
ALMOST = 1e-6  # share of a column that a sum may miss
FIXED = 1e8  # times its precision, that a fitted number is held by


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
    gains: np.ndarray  # whether each is a gain of drives, shape (k,)
    held: np.ndarray  # part of the right side of numbers that are held at their mean, shape (N, nv)

    @classmethod
    def of(
        cls, free: Sequence[FreeNumber], equations: Equations, logs: Sequence[Log],
        wider: float = 1.0,
    ) -> Others:  # fmt: skip
        """Returns those of all free parameters, by the equations of models that have them moved.

        The equations of these logs were made with bands that were `wider` by this factor.
        """
        y, drives = equations.stacked("y"), equations.stacked("drives")
        some, columns = list[FreeNumber](), [np.zeros((*y.shape, 0))]
        for f in free:
            if f.moved is not None:
                rows = make_rows(f.moved, logs, wider=wider)
                some.append(f)
                columns.append((y - np.concatenate([r.y for r in rows]))[:, :, None] / f.step)
        every = np.concatenate(columns, axis=2)
        gains = np.array([_is_sum_of(c, drives) for c in np.moveaxis(every, 2, 0)], bool)
        return cls(free=tuple(some), columns=every, gains=gains, held=np.zeros_like(y))

    def without_gains(self) -> Others:
        """Returns these but for the gains, which are held at their means."""
        keep, off = ~self.gains, np.array([f.value - f.mean for f in self.free])
        held = self.columns @ np.where(self.gains, off, 0.0)
        free = tuple(f for f, k in zip(self.free, keep, strict=True) if k)
        return Others(
            free=free, columns=self.columns[:, :, keep], gains=self.gains[keep],
            held=self.held + held,
        )  # fmt: skip

    @property
    def start(self) -> np.ndarray:
        """Their part of the right side at the values of the model, shape (N, nv)."""
        return np.asarray(self.columns @ np.array([f.value for f in self.free]) + self.held)


def _is_sum_of(column: np.ndarray, drives: np.ndarray) -> bool:
    """Returns whether a column (N, nv) is a sum of the drives' forces (N, nv, nu) at each joint."""
    for of_joint, forces in zip(column.T, np.moveaxis(drives, 1, 0), strict=True):
        left = of_joint - forces @ np.linalg.lstsq(forces, of_joint, rcond=None)[0]
        if np.linalg.norm(left) > ALMOST * np.linalg.norm(of_joint):
            return False
    return bool(column.any())


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A fit with its equations."""

    names: tuple[str, ...]  # of the sizes
    units: tuple[str, ...]  # of them
    base: Base  # what it was fitted to, and the estimate
    inertial: int  # number of sizes of the model, the first ones; frictions follow, then the clock
    added: tuple[Missing, ...] = ()  # effects that are in it, their sizes last

    @property
    def fit(self) -> Estimate:
        """The estimate."""
        return self.base.fit

    def predicted(self) -> np.ndarray:
        """Returns the right side, shape (N, nv)."""
        return np.asarray(self.base.Φ @ self.fit.θ)


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


def _friction_scales(model: mujoco.MjModel, equations: Equations) -> np.ndarray:
    """Returns how large frictions may be at most, roughly, shape (3 nv,).

    As large as the drive's force, or as what the model's masses need where there is no drive.
    """
    v = np.abs(equations.stacked("v")).max(axis=0)
    force = np.abs(equations.stacked("drives").sum(axis=2)).max(axis=0)
    needed = np.abs(model_forces(model, equations)).max(axis=0)
    force = np.where(list_passive(model, equations), needed, force)
    force = np.where(force > 0, force, 1.0)
    return np.stack([force / np.where(v > 0, v, 1.0), force, force], axis=1).ravel()


def _nuisances(
    model: mujoco.MjModel, equations: Equations, expected: np.ndarray
) -> tuple[np.ndarray, np.ndarray, list[str], list[str]]:
    """Returns columns of friction and clock, the std of what is known, names and units."""
    late = rate_of(equations, expected)[:, :, None]
    names, units = friction_names(model)
    columns = np.concatenate([friction_columns(equations.rows), late], axis=2)
    scales = np.append(_friction_scales(model, equations), SHIFT)
    return columns, scales, [*names, CLOCK], [*units, "s"]


def expect_drives(
    model: mujoco.MjModel, equations: Equations, base: BaseParameters, others: Others
) -> np.ndarray:
    """Returns the drives' forces as a fit to all inertial numbers predicts them, shape (N, nv).

    A joint without a drive has none: what the fit predicts there is the noise of its motion.
    """
    force = equations.stacked("drives").sum(axis=2)
    first = base_fit(model, equations, base, np.zeros_like(force), others)
    expected = first.predicted() + force - first.base.y
    return np.where(list_passive(model, equations), 0.0, expected)


def base_fit(
    model: mujoco.MjModel, equations: Equations, base: BaseParameters, expected: np.ndarray,
    others: Others,
) -> Fitted:  # fmt: skip
    """Returns the fit with all inertial numbers free; `expected` are the drives' forces (N, nv)."""
    bodies, a, y = (equations.stacked(n) for n in ("bodies", "a", "y"))
    more, scales, names, units = _nuisances(model, equations, expected)
    Φ = np.concatenate([base.columns(bodies, a), others.columns, more], axis=2)
    P = 1 / np.concatenate([base.scales, [f.std for f in others.free], scales]) ** 2
    θ_0 = np.concatenate([base.values, [f.mean for f in others.free], np.zeros(len(scales))])
    return Fitted(
        names=(*base.names, *(f.name for f in others.free), *names),
        units=(*base.units, *(f.unit for f in others.free), *units),
        inertial=len(base.names) + len(others.free),
        base=_fitted(equations, Φ, y + others.start, P, θ_0),
    )  # fmt: skip


def model_fit(
    model: mujoco.MjModel, equations: Equations, free: Sequence[FreeNumber], expected: np.ndarray,
    others: Others,
) -> Fitted:  # fmt: skip
    """Returns the fit of free numbers; `expected` are the drives' forces (N, nv) [N m or N]."""
    free = [f for f in free if f.moved is None]
    bodies, a = equations.stacked("bodies"), equations.stacked("a")
    X = all_columns(bodies, a)
    known = known_numbers(model)
    change = np.array([f.change for f in free]).reshape(len(free), len(known))
    start = np.array([f.value for f in free])
    y = equations.stacked("y") - X @ (known - start @ change) + others.start
    more, scales, names, units = _nuisances(model, equations, expected)
    every = [*free, *others.free]
    Φ = np.concatenate([X @ change.T, others.columns, more], axis=2)
    P = 1 / np.concatenate([[f.std for f in every], scales]) ** 2
    θ_0 = np.concatenate([[f.mean for f in every], np.zeros(len(scales))])
    return Fitted(
        names=(*(f.name for f in every), *names), units=(*(f.unit for f in every), *units),
        inertial=len(every), base=_fitted(equations, Φ, y, P, θ_0, len(every)),
    )  # fmt: skip


def with_gains_held(fitted: Fitted, others: Others) -> Fitted:
    """Returns a model fit in which later fits hold the gains of drives at what it found."""
    base, gains = fitted.base, np.zeros(len(fitted.names), bool)
    gains[fitted.inertial - len(others.gains) : fitted.inertial] = others.gains
    P = np.where(gains, FIXED / np.maximum(np.diag(base.fit.covariance), 1e-300), base.P)
    fit = replace(base.fit, H=base.fit.H + np.diag(P - base.P))
    θ_0 = np.where(gains, base.fit.θ, base.θ_0)
    return replace(fitted, base=replace(base, P=P, θ_0=θ_0, fit=fit))


def with_std_of_gains(final: Fitted, nominal: Fitted, others: Others) -> Fitted:
    """Returns a fit in which held gains have the std with which the model fit told them."""
    fit, C = final.fit, final.fit.covariance.copy()
    at = np.flatnonzero(others.gains) + final.inertial - len(others.gains)
    C[at, at] = np.diag(nominal.fit.covariance)[at]
    return replace(final, base=replace(final.base, fit=replace(fit, covariance=C)))


def extended(equations: Equations, fitted: Fitted, missing: Missing) -> Fitted:
    """Returns a fit with one effect more, of which nothing was known."""
    S, old, held = missing.columns().values, fitted.base, np.zeros(len(missing.sizes))
    if missing.ridges:
        moments = Weighted(equations, old).moments(missing.columns())
        held = held_by(missing, moments[1][~equations.confirms]) if moments else held
    return Fitted(
        names=(*fitted.names, *(f"{missing.name}.{s}, {missing.where}" for s in missing.sizes)),
        units=(*fitted.units, *missing.units),
        base=_fitted(
            equations, np.concatenate([old.Φ, S], axis=2), old.y,
            np.append(old.P, held), np.append(old.θ_0, 0 * held), old.known,
        ),
        inertial=fitted.inertial,
        added=(*fitted.added, missing),
    )  # fmt: skip


def _fitted(
    equations: Equations, Φ: np.ndarray, y: np.ndarray, P: np.ndarray, θ_0: np.ndarray,
    known: int = 0,
) -> Base:  # fmt: skip
    M = equations.moments(np.concatenate([Φ, y[:, :, None]], axis=2))
    seen = ~equations.confirms
    fit = estimate(M[:, seen], equations.counts[:, seen], P, θ_0)
    return Base(Φ=Φ, y=y, P=P, θ_0=θ_0, fit=fit, M=M, known=known)
