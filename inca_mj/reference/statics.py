"""The platform at rest: pretension, no-load lengths, start state (thesis section 2.4).

With W the 6 × 8 matrix that turns tensions into the wrench on the platform (in O, about P) and
w the wrench that carries the weight,

    W = [−s_i; −b_i × s_i],   w = (0, 0, m g, 0, 0, 0),   W T = w
    T(0) = t₀ + W⁺ (w − W t₀)          the solution nearest to t₀ = 4 N each
    d₀(0) = λ d/(λ + T(0))             so that λ (d − d₀)/d₀ = T(0), each cable with its own λ

The thesis does not say how T(0) was chosen, only that it balances the drum springs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.reference import kinematics
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY, PRETENSION
from inca_mj.robot.spread import at_drives, displaced

UNBALANCED = 1e-9  # largest force [N] or torque [N m] left by the pretension


@dataclass(frozen=True)
class Rest:
    """The robot at rest at its start pose, currents zero.

    Attributes:
        tension: T(0), shape (8,) [N].
        length: d of the cables, shape (8,) [m].
        no_load: d₀(0), shape (8,) [m].
        state: the 36 states of that rest.
    """

    tension: np.ndarray
    length: np.ndarray
    no_load: np.ndarray
    state: np.ndarray


def wrench_matrix(pose: kinematics.CablePose) -> np.ndarray:
    """Returns W: wrench on the platform (force, torque about P, in O) per tension, shape (6, 8)."""
    return -np.vstack([pose.directions.T, np.cross(pose.arms, pose.directions).T])


def rest(parameters: ParameterSet, geometry: Geometry) -> Rest:
    """Returns the rest at the start pose (x, y, z, roll, pitch, yaw) of a parameter set.

    Args:
        parameters: needs `m`, `lambda` and the start pose; takes the deviations of λ and the
            displacements of points that it has.
        geometry: nominal exit points and connectors.

    Raises:
        InputError: a cable has no length, the cables cannot carry the weight at this pose, or
            one of them would have to push.
    """
    value = parameters.values()
    position = np.array([value[name] for name in ("x", "y", "z")])
    euler = np.array([value[name] for name in ("roll", "pitch", "yaw")])
    R_AB = kinematics.rotation(euler)
    placed = displaced(geometry, value)
    _refuse_zero_length(position + placed.B @ R_AB.T - placed.A)
    pose = kinematics.geometric(position, R_AB, placed)

    W = wrench_matrix(pose)
    w = np.array([0.0, 0.0, value["m"] * GRAVITY, 0.0, 0.0, 0.0])
    t_0 = np.full(at.DRIVES, PRETENSION)
    T = t_0 + np.linalg.pinv(W) @ (w - W @ t_0)
    _refuse_unbalanced(W @ T - w)
    _refuse_slack(T)

    λ, d = at_drives("lambda", value), pose.lengths
    d_0 = λ * d / (λ + T)
    state = np.zeros(at.STATES)
    state[at.POSITION], state[at.EULER], state[at.NO_LOAD] = position, euler, d_0
    return Rest(T, d, d_0, state)


def _refuse_zero_length(ds: np.ndarray) -> None:
    d = np.linalg.norm(ds, axis=1)
    if d.min() < 1e-6:
        raise InputError(
            f"start pose: cable {int(d.argmin()) + 1} has no length, its connector sits on its"
            " exit point; change x, y, z or the geometry"
        )


def _refuse_unbalanced(left: np.ndarray) -> None:
    if np.abs(left).max() > UNBALANCED:
        raise InputError(
            "start pose: no tensions of the cables hold the platform at rest here (the wrench"
            " matrix lacks a direction); move the start pose or the connectors"
        )


def _refuse_slack(T: np.ndarray) -> None:
    if T.min() <= 0.0:
        raise InputError(
            f"start pose: drive {int(T.argmin()) + 1} would need a tension of {T.min():.3g} N,"
            " and a cable cannot push; move x, y, z, roll, pitch, yaw towards the centre, or"
            " lower m"
        )
