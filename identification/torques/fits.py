"""The fits of torques: with all inertial numbers free, and with those of the robot's file.

    base fit     every inertial number and every friction is free, up to the size of the whole arm
    model fit    the model's numbers are held but those of the robot's file, with their priors;
                 friction is free
    others       free parameters of the file that change no inertial number, such as a spring's
                 stiffness or a drive's gain, are in both: y(θ) = y(θ_0) + (θ - θ_0) dy/dθ
    clock        in both, the mean shift of all records' inputs against their outputs, a nuisance:
                 dτ_u/dt of what the inputs alone move; by how much the records differ is known
                 already (`identification.torques.clock`)
    gains        free gains of drives are fitted where the model's masses tell them, in the model
                 fit without effects; elsewhere they are held, because a drive without a gain that
                 moves an arm without masses leaves no residual at all (`others.py`)

The base fit says how well a rigid arm with friction can do at all, and needs nothing of the model
but its geometry. The model fit is where a payload can be told from the masses that are known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial, reduce

import mujoco
import numpy as np

from identification.effects.laws.inputs import SHIFT
from identification.torques.equations.base import BaseParameters, all_columns, known_numbers
from identification.torques.equations.equations import (
    Equations,
    Estimate,
    estimate,
    list_passive,
    model_forces,
)
from identification.torques.equations.frictions import friction_columns, friction_names
from identification.torques.equations.others import FreeNumber, Others
from identification.torques.laws import Missing
from identification.torques.moments import Base, Weighted, held_by

CLOCK = "clock of the inputs"
ROUNDS = 6  # of the forces that gains scale
FIXED = 1e8  # times its precision, that a fitted number is held by


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
    model: mujoco.MjModel, equations: Equations, has_clocks: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[str], list[str]]:
    """Returns columns of friction and clocks, the std of what is known, names, units.

    The third of them is the part of the right side that the clocks have already, shape (N, nv).
    """
    names, units = friction_names(model)
    late, of = equations.stacked("late").sum(axis=2)[:, :, None], equations.record[equations.block]
    shifts = np.array([r.shift for r in equations.rows])
    if has_clocks:
        late = late * (of[:, None] == np.arange(len(shifts)))[:, None, :]
        names += [f"{CLOCK} of {r.name}" for r in equations.rows]
    else:
        shifts = shifts.mean(keepdims=True)
        names += [CLOCK]
    columns = np.concatenate([friction_columns(equations.rows), late], axis=2)
    scales = np.append(_friction_scales(model, equations), [SHIFT] * len(shifts))
    return columns, scales, late @ shifts, names, units + ["s"] * len(shifts)


def expect_drives(model: mujoco.MjModel, equations: Equations, whole: Fitted) -> np.ndarray:
    """Returns the drives' forces as the base fit predicts them, shape (N, nv).

    A joint without a drive has none: what the fit predicts there is the noise of its motion.
    """
    expected = whole.predicted() + equations.stacked("drives").sum(axis=2) - whole.base.y
    return np.where(list_passive(model, equations), 0.0, expected)


def base_fit(
    model: mujoco.MjModel, equations: Equations, base: BaseParameters, others: Others,
    has_clocks: bool = False,
) -> Fitted:  # fmt: skip
    """Returns the fit with all inertial numbers free, and a clock for each record if asked for."""
    bodies, a, y = (equations.stacked(n) for n in ("bodies", "a", "y"))
    more, scales, known, names, units = _nuisances(model, equations, has_clocks)
    Φ = np.concatenate([base.columns(bodies, a), others.columns, more], axis=2)
    P = 1 / np.concatenate([base.scales, [f.std for f in others.free], scales]) ** 2
    θ_0 = np.concatenate([base.values, [f.mean for f in others.free], np.zeros(len(scales))])
    return Fitted(
        names=(*base.names, *(f.name for f in others.free), *names),
        units=(*base.units, *(f.unit for f in others.free), *units),
        inertial=len(base.names) + len(others.free),
        base=_fitted(equations, Φ, y + known + others.start, P, θ_0),
    )  # fmt: skip


def gains_fit(
    model: mujoco.MjModel, equations: Equations, free: Sequence[FreeNumber], others: Others,
    expected: np.ndarray, added: Sequence[Missing] = (),
) -> Fitted:  # fmt: skip
    """Returns the model fit with the gains of drives, and with some effects.

    `expected` are the drives' forces (N, nv) as the base fit predicts them [N m or N].
    """
    force = equations.stacked("drives").sum(axis=2)
    for _ in range(ROUNDS if others.gains.any() else 1):
        fitted = model_fit(model, equations, free, others.expecting(expected - force))
        fitted = reduce(partial(extended, equations), added, fitted)
        expected = force + fitted.predicted() - fitted.base.y
    return fitted


def model_fit(
    model: mujoco.MjModel, equations: Equations, free: Sequence[FreeNumber], others: Others
) -> Fitted:
    """Returns the fit of free numbers."""
    free = [f for f in free if f.moved is None]
    bodies, a = equations.stacked("bodies"), equations.stacked("a")
    X = all_columns(bodies, a)
    known = known_numbers(model)
    change = np.array([f.change for f in free]).reshape(len(free), len(known))
    start = np.array([f.value for f in free])
    y = equations.stacked("y") - X @ (known - start @ change) + others.start
    more, scales, of_clocks, names, units = _nuisances(model, equations)
    every = [*free, *others.free]
    Φ = np.concatenate([X @ change.T, others.columns, more], axis=2)
    P = 1 / np.concatenate([[f.std for f in every], scales]) ** 2
    θ_0 = np.concatenate([[f.mean for f in every], np.zeros(len(scales))])
    return Fitted(
        names=(*(f.name for f in every), *names), units=(*(f.unit for f in every), *units),
        inertial=len(every), base=_fitted(equations, Φ, y + of_clocks, P, θ_0, len(every)),
    )  # fmt: skip


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
