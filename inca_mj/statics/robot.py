"""A robot at rest: its pretension, and how its drums pull at cables of given lengths.

    T(0) = t₀ + W⁺ (w − W t₀)         pretension that balances the drum springs
    d₀(0) = λ d/(λ + T(0))            (thesis 2.24, 2.25 at rest)

A drum that turns freely against its spring is in balance at rest where

    T = B − κ φ,   B = T(0) + K_t i/R,   κ = k_s R_s²/R          (2.40, 2.41 at rest)
    R dφ = −(1 + ε) dd₀,   ε = T/λ = (d − d₀)/d₀                 (2.25, 2.30)

If it turns slowly, dε = −κ dφ/λ, and the two equations can be integrated:

    d₀ = d₀(0) + (R λ/κ) ln((1 + ε)/(1 + B/λ)),   d = (1 + ε) d₀
    dd/dT = d₀/λ + R/κ         the cable's own spring and the drum's spring stand in series

d grows with T, so T of a given d is found by Newton steps. A drum spring that is unwound does not
push: then the motor's current alone pulls, T = max(0, K_t i/R).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.elastic import Robot, robot_of
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY, POSE
from inca_mj.robot.spread import at_drives, displaced
from inca_mj.statics.tensions import nearest

STEPS = 12  # many more than enough: the equation is almost a straight line


def static_robot(parameters: ParameterSet, geometry: Geometry) -> Robot:
    """Returns the robot of a parameter set, with deviations of its drives and displaced points.

    Args:
        parameters: values of all parameters; the start pose is among them.
        geometry: nominal anchors of the cables.

    Raises:
        InputError: the cables cannot hold the platform at its start, or one would have to push.
    """
    values = parameters.values()
    λ, start = at_drives("lambda", values), np.array([values[name] for name in POSE])
    at = inverse(start, displaced(geometry, values))
    T = nearest(at.W, np.array([0, 0, values["m"] * GRAVITY, 0, 0, 0]))
    if T.min() <= 0:
        raise InputError(
            f"cable {T.argmin() + 1} would have to push ({T.min():.3g} N) at the start pose"
            f" {np.round(start, 4).tolist()}; move the start towards the middle, or lower m"
        )
    return robot_of(values, geometry, T, λ * at.lengths / (λ + T))


@dataclass(frozen=True)
class Pull:
    """The pull of eight cables of given lengths whose drums are in balance."""

    tension: np.ndarray  # T, shape (..., 8) [N]
    angle: np.ndarray  # φ, positive winds in, shape (..., 8) [rad]
    no_load: np.ndarray  # d₀, shape (..., 8) [m]
    stiffness: np.ndarray  # dT/dd, zero where the drum spring is unwound, shape (..., 8) [N/m]


def pull(robot: Robot, d: np.ndarray, current: float | np.ndarray = 0.0) -> Pull:
    """Returns the pull at cable lengths d (..., 8) [m], with constant currents, one or (8,) [A]."""
    λ, κ, R = robot.lambda_, robot.drum, robot.R
    motor = np.maximum(0.0, robot.K_t * current / R)
    B = robot.tension + robot.K_t * current / R
    first = np.maximum(1 + B / λ, 0.5)  # an unwound spring's cable is slack long before
    strained = np.broadcast_to(first, d.shape).copy()  # 1 + ε
    for _ in range(STEPS):  # κ times the equation, so that κ = 0 is a drum of constant pull
        log = np.log(strained / first)
        wrong = κ * (robot.no_load * strained - d) + R * λ * strained * log
        strained = strained - wrong / (κ * robot.no_load + R * λ * (1 + log))
        strained = np.maximum(strained, 0.5)
    T = λ * (strained - 1)
    unwound = motor >= T
    T = np.where(unwound, motor, T)
    d_0 = d / (1 + T / λ)
    # of an unwound spring: from the angle at which it went slack on, at constant tension
    slack_0 = robot.no_load + _over(R * λ, κ) * np.log((1 + motor / λ) / first)
    more = (slack_0 - d_0) * (1 + motor / λ) / R
    constant = (robot.no_load - d_0) * (1 + T / λ) / R
    angle = np.where(κ > 0, _over(B - T, κ) + np.where(unwound, more, 0.0), constant)
    stiffness = np.where(unwound | (κ == 0), 0.0, _over(1.0, d_0 / λ + _over(R, κ)))
    return Pull(T, angle, d_0, stiffness)


def _over(a: float | np.ndarray, b: np.ndarray) -> np.ndarray:
    """Returns a/b, zero where b is zero."""
    shape = np.broadcast_shapes(np.shape(a), np.shape(b))
    return np.divide(a, b, where=np.broadcast_to(b, shape) != 0, out=np.zeros(shape))
