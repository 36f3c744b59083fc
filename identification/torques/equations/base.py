"""Base parameters: the combinations of inertial numbers that torques can tell.

    Y x = Y_i (x_i + K x_d),   Y_d = Y_i K          x: ten numbers of each body, armatures

A column of Y is taken in turn from the base to the tip, and is one of Y_i where it is no sum of
those before it, over random states of the joints (Gautier, Khalil 1990; Gautier 1991). So what an
outer body cannot tell by itself goes to the bodies that carry it, as it is usual. Which of these
combinations the records tell is another question: their std answers it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.torques.equations.bodies import (
    NUMBERS,
    UNITS,
    label_of,
    list_bodies,
    read_numbers,
    regressor,
)

LIGHT, SHORT = 0.01, 0.05  # of all that moves: a body has at least so much mass and length
STATES = 60  # random ones, for each joint
DEPENDENT = 1e-8  # share of a column that is no sum of the others, below which it is one
LEAST = 1e-7  # factor of a number in a combination, relative to the largest: less is rounding
ORDER = (4, 7, 8, 5, 9, 6, 1, 2, 3, 0)  # of the numbers of a body: inertias, moments, mass


@dataclass(frozen=True)
class Inertia:
    """The inertial numbers of a model, in the order in which base parameters are looked for."""

    names: tuple[str, ...]  # of n numbers, such as "h_x of forearm" and "armature of elbow"
    units: tuple[str, ...]  # of each
    values: np.ndarray  # of the model, shape (n,)
    scales: np.ndarray  # of each, by the mass and the length of all that moves, shape (n,)
    own: np.ndarray  # of each, by its body's own, shape (n,)
    place: np.ndarray  # of each in (bodies · 10 numbers, joints), shape (n,)
    bodies: int  # number of bodies


@dataclass(frozen=True)
class BaseParameters:
    """Combinations of inertial numbers that the torques tell apart."""

    inertia: Inertia  # the numbers
    independent: np.ndarray  # places of those that begin a combination, shape (r,)
    K: np.ndarray  # x_i + K x_d as factors of all numbers, shape (r, n)

    @property
    def values(self) -> np.ndarray:
        """The model's values, shape (r,)."""
        return np.asarray(self.K @ self.inertia.values)

    @property
    def scales(self) -> np.ndarray:
        """How large they may be at most, roughly, shape (r,)."""
        return self.inertia.scales[self.independent]

    @property
    def units(self) -> tuple[str, ...]:
        """Their units."""
        return tuple(self.inertia.units[i] for i in self.independent)

    @property
    def names(self) -> tuple[str, ...]:
        """What they are made of, such as "h_x of upper + 0.5 m of fore"."""
        return tuple(self._name(i, row) for i, row in zip(self.independent, self.K, strict=True))

    def _name(self, first: int, row: np.ndarray) -> str:
        rest = [k for k in np.flatnonzero(row) if k != first]
        parts = [self.inertia.names[first]]
        for k in rest:
            factor = abs(row[k])
            times = "" if abs(factor - 1) < LEAST else f"{factor:.4g} "
            parts.append(f"{'-' if row[k] < 0 else '+'} {times}{self.inertia.names[k]}")
        return " ".join(parts)

    def columns(self, bodies: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Returns Y_i, shape (N, nv, r), of Y (N, nv, bodies, 10) and accelerations (N, nv)."""
        return all_columns(bodies, a)[:, :, self.inertia.place[self.independent]]


def known_numbers(model: mujoco.MjModel) -> np.ndarray:
    """Returns a model's numbers of bodies and armatures, as `all_columns` has them."""
    return np.concatenate([read_numbers(model).ravel(), model.dof_armature])


def all_columns(bodies: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Returns columns of all inertial numbers by place, shape (N, nv, bodies · 10 + nv)."""
    N, nv = a.shape
    armatures = np.zeros((N, nv, nv))
    every = np.arange(nv)
    armatures[:, every, every] = a
    return np.concatenate([bodies.reshape(N, nv, -1), armatures], axis=2)


def read_inertia(model: mujoco.MjModel) -> Inertia:
    """Returns the inertial numbers of a model's moving bodies and joints."""
    bodies, numbers = list_bodies(model), read_numbers(model)
    mass, length = max(float(numbers[:, 0].sum()), 1e-12), reach_of(model)
    power = np.array([0, 1, 1, 1, 2, 2, 2, 2, 2, 2])
    lengths = _lengths(model, bodies, length)
    rows: list[tuple[str, str, float, float, float, int]] = []
    for i, b in enumerate(bodies):
        m, own_length = max(numbers[i, 0], LIGHT * mass), lengths[i]
        of_body = [
            (f"{NUMBERS[k]} of {label_of(model, b)}", UNITS[k], numbers[i, k],
             mass * length ** power[k], m * own_length ** power[k], 10 * i + k)
            for k in ORDER
        ]  # fmt: skip
        rows += of_body[:6]
        for j in range(model.body_jntadr[b], model.body_jntadr[b] + model.body_jntnum[b]):
            n = 0 if int(model.jnt_type[j]) == int(mujoco.mjtJoint.mjJNT_SLIDE) else 2
            d = int(model.jnt_dofadr[j])
            rows.append(
                (f"armature of {model.joint(j).name}", "kg m^2" if n else "kg",
                 model.dof_armature[d], mass * length**n, m * own_length**n, 10 * len(bodies) + d)
            )  # fmt: skip
        rows += of_body[6:]
    names, units, *arrays = zip(*rows, strict=True)
    values, scales, own, place = map(np.array, arrays)
    return Inertia(names, units, values, scales, own, place, len(bodies))


def _lengths(model: mujoco.MjModel, bodies: Sequence[int], length: float) -> list[float]:
    """Returns how far masses of each body may be from its frame, roughly [m]."""
    out = []
    for b in bodies:
        children = [c for c in range(model.nbody) if model.body_parentid[c] == b and c != b]
        ways = [model.body_pos[c] for c in children]
        far = max(float(np.linalg.norm(p)) for p in (model.body_ipos[b], *ways))
        out.append(max(far, SHORT * length))
    return out


def find_base(model: mujoco.MjModel) -> BaseParameters:
    """Returns the base parameters of a robot of hinges and slides."""
    inertia, rng = read_inertia(model), np.random.default_rng(0)
    n = STATES * model.nv
    q, v, a = (rng.normal(0, s, (n, model.nv)) for s in (2.0, 2.0, 4.0))
    Y, _ = regressor(model, q, v, a)
    X = all_columns(Y, a)[:, :, inertia.place].reshape(n * model.nv, -1)
    size = np.linalg.norm(X, axis=0)
    largest = float((size * inertia.scales).max())
    chosen = independent_columns(X, DEPENDENT * largest / inertia.scales, DEPENDENT)
    scaled = X[:, chosen] / size[chosen]
    K = np.linalg.lstsq(scaled, X, rcond=None)[0] / size[chosen][:, None]
    K[:, chosen] = np.eye(len(chosen))
    relative = np.abs(K) * inertia.scales[None, :] / inertia.scales[chosen][:, None]
    K[relative < LEAST] = 0.0
    return BaseParameters(inertia, chosen, K)


def independent_columns(X: np.ndarray, least: np.ndarray | float, unlike: float) -> np.ndarray:
    """Returns the columns of X (m, n), in their order, that are no sums of those before them.

    A column counts if its norm exceeds `least`, of each or of all, and if more than the share
    `unlike` of it is left without those before it.
    """
    size, Q = np.linalg.norm(X, axis=0), np.empty((len(X), 0))
    out = []
    for k in np.flatnonzero(size > least):
        x = X[:, k] / size[k]
        for _ in range(2):  # twice is enough (Giraud, Langou 2005)
            x = x - Q @ (Q.T @ x)
        if (left := float(np.linalg.norm(x))) > unlike:
            Q = np.column_stack([Q, x / left])
            out.append(k)
    return np.array(out, int)


def reach_of(model: mujoco.MjModel) -> float:
    """Returns how far the farthest centre of mass is from the first joint at most [m]."""
    far, most = np.zeros(model.nbody), 0.0
    for b in range(1, model.nbody):
        own = 0.0 if model.body_weldid[model.body_parentid[b]] == 0 else 1.0
        step = own * float(np.linalg.norm(model.body_pos[b]))
        far[b] = far[model.body_parentid[b]] + step
        if model.body_weldid[b]:
            most = max(most, far[b] + float(np.linalg.norm(model.body_ipos[b])))
    return most or 1.0
