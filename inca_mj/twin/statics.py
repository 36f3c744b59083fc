"""The pretensioned start: tensions that hold the platform at rest, and the no-load lengths.

    W T = w,   W = [-s_i ; -(R b_i × s_i)]        wrench of the cables on the platform, 6 × 8
    T(0) = t₀ + W⁺ (w - W t₀)                     nearest (least squares) to t₀ = 4 N each
    d₀(0) = λ d/(λ + T(0))                        (thesis 2.24, 2.25 at rest)

w = (0, 0, m g, 0, 0, 0) is the weight to carry. `inca_mj.twin.at_rest` says how candidate effects
change this.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from identification.model.rollout import State
from inca_mj.effects.hooks import Layout
from inca_mj.effects.values import about_centre
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.jacobians import length_jacobian
from inca_mj.kinematics.rotations import quaternion, rotation
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY, POSE, PRETENSION
from inca_mj.robot.spread import at_drives, displaced
from inca_mj.twin.at_rest import Change, change_at_rest, own_states

NO_EFFECTS = Layout()


@dataclass(frozen=True, kw_only=True)
class Start:
    """A robot at rest, all angles zero: where a log begins."""

    pose: np.ndarray  # x, y, z [m], roll, pitch, yaw [rad], shape (6,)
    tension: np.ndarray  # T(0), shape (8,) [N]
    no_load_length: np.ndarray  # d₀(0), shape (8,) [m]
    strain: np.ndarray  # ε(0) of each cable, shape (8,)
    # tensions that the drum springs balance, with the radius R of the model, shape (8,) [N]
    balance: np.ndarray
    own: np.ndarray  # the effects' own states, shape (8, states)


def pretension(
    pose: np.ndarray, geometry: Geometry, m: float, change: Change | None = None
) -> np.ndarray:
    """Returns T(0) nearest to 4 N that hold a platform of mass m [kg] at a pose, shape (8,) [N].

    `change` says how effects change the paths of the cables and the load. Raises InputError if a
    cable has no length or would have to push, or the cables cannot hold the platform.
    """
    R = rotation(*pose[3:])
    d = np.linalg.norm(pose[:3] + geometry.B @ R.T - geometry.A, axis=1)
    if d.min() < 1e-3:
        raise InputError(
            f"cable {d.argmin() + 1} has no length at pose {np.round(pose, 4).tolist()}; move its"
            " exit point or the start pose"
        )
    W = -length_jacobian(pose[:3], R, geometry).T
    w = np.array([0, 0, m * GRAVITY, 0, 0, 0])
    if change is not None:
        W = W - np.hstack([change.turned, np.cross(geometry.B @ R.T, change.turned)]).T
        w = w + change.load
    t_0 = np.full(len(geometry.exits), PRETENSION)
    T = t_0 + np.linalg.pinv(W) @ (w - W @ t_0)
    if np.abs(W @ T - w).max() > 1e-9 * max(1.0, m * GRAVITY):
        raise InputError(
            f"the cables cannot hold the platform at pose {np.round(pose, 4).tolist()}:"
            f" their wrench matrix has rank {np.linalg.matrix_rank(W)} of 6;"
            " move the start pose or the connectors"
        )
    if T.min() <= 0:
        raise InputError(
            f"cable {T.argmin() + 1} would have to push ({T.min():.3g} N) to hold the platform at"
            f" pose {np.round(pose, 4).tolist()}; move the start towards the middle, or lower m"
        )
    return T


def start(parameters: ParameterSet, geometry: Geometry, layout: Layout = NO_EFFECTS) -> Start:
    """Returns the start implied by parameters and geometry; refuses as `pretension` does."""
    return start_from(parameters.values(), geometry, layout)


def start_from(
    values: Mapping[str, float], geometry: Geometry, layout: Layout = NO_EFFECTS
) -> Start:
    """Returns `start` from plain values by name, in SI units, with changes by candidate effects."""
    pose = np.array([values[name] for name in POSE])
    placed, λ = displaced(geometry, values), at_drives("lambda", values)
    moved = about_centre(placed, layout.effects, values)
    change = change_at_rest(values, pose, moved, layout)
    T = pretension(pose, moved if layout.settled else placed, values["m"], change)
    d = cables_at(pose[:3], rotation(*pose[3:]), moved).lengths
    strain, balance = T / λ, T
    d_0 = λ * d / (λ + T)
    if change is not None:
        strain = change.strain(T)
        d_0 = (d + change.longer) / (1 + strain)
        balance = T * (1 + change.wider / at_drives("R", values))
    own = own_states(values, strain, layout)
    return Start(pose=pose, tension=T, no_load_length=d_0, strain=strain, balance=balance, own=own)


def starts_from(
    own: Mapping[str, float], names: Sequence[str], values: np.ndarray, geometry: Geometry,
    layout: Layout = NO_EFFECTS,
) -> list[Start]:  # fmt: skip
    """Returns `start_from` for n value sets: `values` (n, p) of the named parameters, else `own`.

    Sets that agree with the first in all values that its start was made of share that start: most
    columns of a Jacobian move a parameter that no start asks for.
    """
    asked = _Asked({**own, **dict(zip(names, values[0], strict=True))})
    first = start_from(asked, geometry, layout)
    seen = [k for k, name in enumerate(names) if name in asked.names]
    same = (values[:, seen] == values[0, seen]).all(axis=1)
    return [
        first if alike
        else start_from({**own, **dict(zip(names, row, strict=True))}, geometry, layout)
        for alike, row in zip(same, values, strict=True)
    ]  # fmt: skip


class _Asked(Mapping[str, float]):
    """Values, and the names that were asked for."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self._values = values
        self.names: set[str] = set()

    def __getitem__(self, name: str) -> float:
        self.names.add(name)
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        self.names.update(self._values)
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


def activations(begin: Start) -> np.ndarray:
    """Returns the twin's activations at a start: d₀ of each drive, then its effects' own states."""
    return np.column_stack([begin.no_load_length, begin.own]).ravel()


def start_state(begin: Start) -> State:
    """Returns a start as a MuJoCo state: qpos (15,), qvel (14,), act (8 (1 + own states),)."""
    drives = len(begin.tension)
    qpos = np.concatenate([begin.pose[:3], quaternion(*begin.pose[3:]), np.zeros(drives)])
    return State(qpos, np.zeros(6 + drives), activations(begin))
