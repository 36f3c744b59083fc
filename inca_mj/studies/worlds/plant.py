"""A robot with its effects: the numbers of its equations, and its start at rest.

With s_i, d_i the true paths of the cables, b_i from the true centre of mass,

    W = [−s_i; −b_i × s_i],  W T = (0, 0, m g, 0) − what else the pretension carries
    T(0) = t₀ + W⁺ (w − W t₀)                                the solution nearest to t₀ = 4 N each
    λ ε (1 + κ ε^n) = T(0),  d₀(0) = d_path/(1 + ε)    d_path with the sag, where there is one
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.model.parameter import ParameterSet
from inca_mj.reference import layout as base
from inca_mj.reference import pack, rotation_matrix
from inca_mj.robot.geometry import DRIVES, Geometry
from inca_mj.robot.parameters import GRAVITY, PRETENSION
from inca_mj.robot.spread import at_drives, displaced
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import HiddenEffect, HiddenNumbers
from inca_mj.studies.worlds.equations import path
from inca_mj.studies.worlds.integrate import PLAY_STEP, STEP, trajectory


@dataclass(frozen=True)
class HiddenPlant:
    """The numbers of one robot; its arrays are read-only."""

    q: np.ndarray  # packed numbers of the reference, at the true geometry, shape (147,)
    D: np.ndarray  # numbers of the drives, shape (8, 49)
    P: np.ndarray  # numbers of the platform, shape (3,)
    start: np.ndarray  # first state, shape (60,)

    def __post_init__(self) -> None:
        for array in (self.q, self.D, self.P, self.start):
            array.setflags(write=False)


def make_plant(
    parameters: ParameterSet, geometry: Geometry, effects: Sequence[HiddenEffect] = ()
) -> HiddenPlant:
    """Returns a robot with effects at rest at the start pose of its true parameters.

    Raises InputError if no tensions that pull hold the platform there.
    """
    value = parameters.values()
    placed, λ = displaced(geometry, value), at_drives("lambda", value)
    n = HiddenNumbers(placed.A, placed.B)
    for effect in effects:
        effect.put(n)
    q = pack(parameters, geometry)
    q[base.EXITS], q[base.CONNECTORS] = n.A.ravel(), n.B.ravel()
    q[base.FORCE], q[base.FORCE_AT] = n.force, -n.centre
    euler = np.array([value[name] for name in ("roll", "pitch", "yaw")])
    R_AB = rotation_matrix(euler)
    p = np.array([value[name] for name in ("x", "y", "z")]) + R_AB @ n.centre

    arms = n.B @ R_AB.T
    ds = p + arms - n.A
    paths = [
        path(tuple(row), D[at.PULLEY], D[at.PULLEY_SIDE]) for row, D in zip(ds, n.D, strict=True)
    ]
    d, s = np.array([length for length, _ in paths]), np.array([list(u) for _, u in paths])
    T = _pretension(n, s, arms, d, value["m"], R_AB)
    q[base.PRETENSION] = T
    ε = np.array([_strain(*each) for each in zip(T, λ, n.D, strict=True)])
    x = np.zeros(at.STATES)
    x[base.POSITION], x[base.EULER] = p, euler
    w = n.D[:, at.SAG] * n.D[:, at.LINE_WEIGHT] * GRAVITY * np.hypot(ds[:, 0], ds[:, 1])
    x[base.NO_LOAD] = (d + d * w**2 / (24 * T**2)) / (1 + ε)
    x[at.VISCOUS] = d / x[base.NO_LOAD] - 1
    return HiddenPlant(q, n.D, n.P, x)


def simulate_world(
    plant: HiddenPlant, currents: np.ndarray, sampling_time: float = 0.01, step: float | None = None
) -> np.ndarray:
    """Returns states at the samples (n, 60), under commanded currents (n, 8) [A] that are held.

    The largest step of the integrator [s], where none is given, leaves 1e-8 rad of error in 20 s,
    or 5e-5 rad where a drum plays.

    Raises:
        InputError: the currents have another shape.
        DivergenceError: the state left the finite numbers.
    """
    u = np.ascontiguousarray(currents, dtype=float)
    if u.ndim != 2 or u.shape[1] != DRIVES or not np.isfinite(u).all():
        raise InputError(f"currents must be finite numbers of shape (n, {DRIVES}) [A]")
    if step is None:  # the edges of a play fall inside steps, and cost them their order
        step = PLAY_STEP if plant.D[:, at.PLAY].any() else STEP
    X: np.ndarray = trajectory(
        plant.start, u, float(sampling_time), plant.q, plant.D, plant.P, float(step)
    )
    if not np.isfinite(X[-1]).all():
        t = np.argmin(np.isfinite(X[:, 0])) * sampling_time
        raise DivergenceError(
            f"the world left the finite numbers at t = {t:g} s; give its effects smaller sizes, or"
            " a smaller step"
        )
    return X


def _pretension(
    n: HiddenNumbers, s: np.ndarray, arms: np.ndarray, d: np.ndarray, m: float, R_AB: np.ndarray
) -> np.ndarray:
    if not np.isfinite(d).all():
        raise InputError(
            f"pulley_radius: the connector of cable {int(np.isfinite(d).argmin()) + 1} is inside"
            " its pulley; give a smaller radius"
        )
    W = -np.vstack([s.T, np.cross(arms, s).T])
    w = np.array([0.0, 0.0, m * GRAVITY, 0.0, 0.0, 0.0])
    w[:3] -= n.carried
    w[3:] -= np.cross(-R_AB @ n.centre, n.carried)
    if n.weight_carried:
        hangs = np.outer(0.5 * n.D[:, at.LINE_WEIGHT] * d, [0.0, 0.0, -GRAVITY])
        w[:3] -= hangs.sum(axis=0)
        w[3:] -= np.cross(arms, hangs).sum(axis=0)
    t_0 = np.full(DRIVES, PRETENSION)
    T = t_0 + np.linalg.pinv(W) @ (w - W @ t_0)
    if np.abs(W @ T - w).max() > 1e-9 or T.min() <= 0:
        raise InputError("no tensions that pull hold the platform at rest at this start pose")
    return T


def _strain(T: float, λ: float, D: np.ndarray) -> float:
    """Returns ε of λ ε (1 + κ ε^n) = T, by Newton from ε = T/λ."""
    κ, n = D[at.CABLE_HARD], D[at.CABLE_POWER]
    ε = T / λ
    for _ in range(30 if κ != 0.0 else 0):
        ε -= (λ * ε * (1 + κ * ε**n) - T) / (λ * (1 + (n + 1) * κ * ε**n))
    if not (ε > 0 and abs(λ * ε * (1 + κ * ε**n) - T) < 1e-9 * T):
        raise InputError(f"cable_hardening: kappa = {κ:g} leaves no strain that carries {T:.3g} N")
    return ε
