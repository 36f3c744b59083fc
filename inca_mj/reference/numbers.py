"""The constants of the equations in one flat array, and the platform at rest (thesis section 2.4).

Every drive has numbers of its own, and every point its own place: `inca_mj.robot.spread` says how
the deviations and displacements of the parameters give them. With W the 6 × 8 matrix that turns
tensions into the wrench on the platform (in O, about P) and w the wrench that carries the weight,

    W = [−s_i; −b_i × s_i],   w = (0, 0, m g, 0, 0, 0),   W T = w
    T(0) = t₀ + W⁺ (w − W t₀)          the solution nearest to t₀ = 4 N each
    d₀(0) = λ d/(λ + T(0))             so that λ (d − d₀)/d₀ = T(0), each cable with its own λ

The thesis does not say how T(0) was chosen, only that it balances the drum springs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.reference import equations
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY, PRETENSION
from inca_mj.robot.spread import at_drives, displaced

NO_FORCE = (0.0, 0.0, 0.0)
UNBALANCED = 1e-9  # largest force [N] or torque [N m] left by the pretension


def pack(
    parameters: ParameterSet,
    geometry: Geometry,
    *,
    force: Sequence[float] = NO_FORCE,
    force_at: Sequence[float] = NO_FORCE,
) -> np.ndarray:
    """Returns the numbers q of `derivative(x, i, q)`, shape (147,).

    The drum springs balance the pretension of the parameters' start pose. A constant `force` G, in
    O [N], at the point b_G of the platform [m] is no part of that balance: it acts from the first
    instant on. Raises InputError if either is not 3 finite numbers, or no rest exists.
    """
    value = parameters.values()
    q = np.empty(at.NUMBERS)
    q[at.ROWS] = np.column_stack([at_drives(name, value) for name in at.EACH_DRIVE]).ravel()
    q[at.M], q[at.INERTIA] = value["m"], [value[name] for name in ("I_x", "I_y", "I_z")]
    q[at.G_EARTH] = GRAVITY
    q[at.FORCE], q[at.FORCE_AT] = _three("force", force, "N"), _three("force_at", force_at, "m")
    placed = displaced(geometry, value)
    q[at.EXITS], q[at.CONNECTORS] = placed.A.ravel(), placed.B.ravel()
    q[at.PRETENSION] = rest(parameters, geometry).tension
    return q


@dataclass(frozen=True)
class Rest:
    """The robot at rest at its start pose, currents zero."""

    tension: np.ndarray  # T(0), shape (8,) [N]
    length: np.ndarray  # d of the cables, shape (8,) [m]
    no_load: np.ndarray  # d₀(0), shape (8,) [m]
    state: np.ndarray  # the 36 states of that rest


def rotation_matrix(euler: np.ndarray) -> np.ndarray:
    """Returns R_AB from roll, pitch, yaw [rad], shape (3, 3) (2.1)."""
    return np.array(list(equations.rotation(equations.vector(np.asarray(euler, float)))))


def rest(parameters: ParameterSet, geometry: Geometry) -> Rest:
    """Returns the rest at the start pose (x, y, z, roll, pitch, yaw) of a parameter set.

    Raises InputError if a cable has no length, the cables cannot carry the weight at this pose, or
    one of them would have to push.
    """
    value = parameters.values()
    position = np.array([value[name] for name in ("x", "y", "z")])
    euler = np.array([value[name] for name in ("roll", "pitch", "yaw")])
    placed = displaced(geometry, value)
    b = placed.B @ rotation_matrix(euler).T
    ds = position + b - placed.A  # along the cables, from A_i to B_i (2.6 - 2.8)
    d = np.linalg.norm(ds, axis=1)
    if d.min() < 1e-6:
        raise InputError(
            f"start pose: cable {int(d.argmin()) + 1} has no length, its connector sits on"
            " its exit point; change x, y, z or the geometry"
        )
    s = ds / d[:, None]
    W = -np.vstack([s.T, np.cross(b, s).T])
    w = np.array([0.0, 0.0, value["m"] * GRAVITY, 0.0, 0.0, 0.0])
    t_0 = np.full(at.DRIVES, PRETENSION)
    T = t_0 + np.linalg.pinv(W) @ (w - W @ t_0)
    if np.abs(W @ T - w).max() > UNBALANCED:
        raise InputError(
            "start pose: no tensions of the cables hold the platform at rest here (the wrench"
            " matrix lacks a direction); move the start pose or the connectors"
        )
    if T.min() <= 0.0:
        raise InputError(
            f"start pose: drive {int(T.argmin()) + 1} would need a tension of {T.min():.3g} N,"
            " and a cable cannot push; move x, y, z, roll, pitch, yaw towards the centre, or"
            " lower m"
        )

    λ = at_drives("lambda", value)
    d_0 = λ * d / (λ + T)
    state = np.zeros(at.STATES)
    state[at.POSITION], state[at.EULER], state[at.NO_LOAD] = position, euler, d_0
    return Rest(T, d, d_0, state)


def _three(name: str, numbers: Sequence[float], unit: str) -> np.ndarray:
    try:
        array = np.asarray(numbers, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise InputError(f"{name} must be 3 finite numbers [{unit}], got {numbers!r}")
    return array
