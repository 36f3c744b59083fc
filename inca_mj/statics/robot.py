"""The numbers that statics needs of a robot, where its cables run, and how its drums pull at them.

d_i s_i = p + r_i − a_i,  r_i = R b_i                  (thesis 2.6 to 2.8)
W = [−s_i; −r_i × s_i]                                 wrench per tension, in O, about P
T(0) = t₀ + W⁺ (w − W t₀)                              pretension that balances the drum springs
d₀(0) = λ d/(λ + T(0))                                 (2.24, 2.25 at rest)

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
from scipy.spatial.transform import Rotation

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY
from inca_mj.robot.spread import at_drives, displaced
from inca_mj.statics.tensions import nearest

STEPS = 12  # many more than enough: the equation is almost a straight line
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
SHORTEST = 1e-3  # a cable of less has no direction [m]


@dataclass(frozen=True)
class Lines:
    """Straight cables at one pose or at many; ... stands for the poses.

    Attributes:
        d: lengths, shape (..., 8) [m].
        s: unit vectors from exit to connector in O, shape (..., 8, 3), without unit.
        r: connectors relative to the platform's centre in O, shape (..., 8, 3) [m].
    """

    d: np.ndarray
    s: np.ndarray
    r: np.ndarray

    @property
    def W(self) -> np.ndarray:
        """Wrench of the cables on the platform per tension, shape (..., 6, 8) [-, m]."""
        rows = np.concatenate([self.s, np.cross(self.r, self.s)], axis=-1)
        return -np.swapaxes(rows, -1, -2)


def turn(pose: np.ndarray) -> np.ndarray:
    """Returns rotations Rz Ry Rx (thesis 2.1) of poses, shape (..., 6) [m, rad] -> (..., 3, 3)."""
    pose = np.asarray(pose, float)
    angles = pose[..., :2:-1].reshape(-1, 3)  # yaw, pitch, roll
    return Rotation.from_euler("ZYX", angles).as_matrix().reshape(*pose.shape[:-1], 3, 3)


def lines(pose: np.ndarray, geometry: Geometry) -> Lines:
    """Returns the straight cables at poses.

    Args:
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,) or (N, 6).
        geometry: anchors of the cables.

    Raises:
        InputError: a pose is not six finite numbers, or a cable has no length there.
    """
    pose = np.asarray(pose, float)
    if pose.shape[-1:] != (6,) or not np.isfinite(pose).all():
        raise InputError(
            f"a pose is six finite numbers x, y, z [m], roll, pitch, yaw [rad], not {pose.tolist()}"
        )
    found = lines_of_many(pose, geometry)
    if found.d.size and found.d.min() <= SHORTEST:
        at = np.unravel_index(found.d.argmin(), found.d.shape)
        raise InputError(
            f"cable {at[-1] + 1} has no length at pose {np.round(pose[at[:-1]], 4).tolist()};"
            " give a pose that is farther from its exit point"
        )
    return found


def lines_of_many(pose: np.ndarray, geometry: Geometry) -> Lines:
    """Returns `lines` without its checks, for grids: a cable is taken to be a millimetre at least.

    Args:
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (..., 6).
        geometry: anchors of the cables.
    """
    r = geometry.B @ np.swapaxes(turn(pose), -1, -2)
    span = pose[..., None, :3] + r - geometry.A
    d = np.maximum(np.linalg.norm(span, axis=-1), SHORTEST)
    return Lines(d, span / d[..., None], r)


@dataclass(frozen=True, kw_only=True)
class Robot:
    """A robot whose drum springs balance the pretension at its start pose.

    Attributes:
        geometry: anchors, where they truly are.
        start: pose at which all motor angles are zero, shape (6,) [m, rad].
        tension: T(0) at the start, shape (8,) [N].
        no_load: d₀(0), shape (8,) [m].
        m: mass of the platform [kg].
        I: its principal inertias about body axes, shape (3,) [kg m^2].
        lambda_: λ of each cable, shape (8,) [N].
        R: radius of each roller, shape (8,) [m].
        drum: κ = k_s R_s²/R, tension that a drum spring loses per turn, shape (8,) [N/rad].
        K_t: torque constants, shape (8,) [N m/A].
        J: inertia of each motor, shape (8,) [kg m^2].
        b_c: Coulomb friction of each motor, shape (8,) [N m].
    """

    geometry: Geometry
    start: np.ndarray
    tension: np.ndarray
    no_load: np.ndarray
    m: float
    I: np.ndarray
    lambda_: np.ndarray
    R: np.ndarray
    drum: np.ndarray
    K_t: np.ndarray
    J: np.ndarray
    b_c: np.ndarray

    @property
    def weight(self) -> np.ndarray:
        """Wrench that the cables exert to carry the platform, in O, shape (6,) [N, N m]."""
        return np.array([0, 0, self.m * GRAVITY, 0, 0, 0])


def static_robot(parameters: ParameterSet, geometry: Geometry) -> Robot:
    """Returns the robot of a parameter set, with deviations of its drives and displaced points.

    Args:
        parameters: values of all parameters; the start pose is among them.
        geometry: nominal anchors of the cables.

    Raises:
        InputError: the cables cannot hold the platform at its start, or one would have to push.
    """
    values = parameters.values()
    each = {
        name: at_drives(name, values) for name in ("R", "R_s", "k_s", "lambda", "K_t", "J", "b_c")
    }
    placed, start = displaced(geometry, values), np.array([values[name] for name in POSE])
    at, weight = lines(start, placed), np.array([0, 0, values["m"] * GRAVITY, 0, 0, 0])
    T = nearest(at.W, weight)
    if T.min() <= 0:
        raise InputError(
            f"cable {T.argmin() + 1} would have to push ({T.min():.3g} N) at the start pose"
            f" {np.round(start, 4).tolist()}; move the start towards the middle, or lower m"
        )
    return Robot(
        geometry=placed,
        start=start,
        tension=T,
        no_load=each["lambda"] * at.d / (each["lambda"] + T),
        m=values["m"],
        I=np.array([values[f"I_{axis}"] for axis in "xyz"]),
        lambda_=each["lambda"],
        R=each["R"],
        drum=each["k_s"] * each["R_s"] ** 2 / each["R"],
        K_t=each["K_t"],
        J=each["J"],
        b_c=each["b_c"],
    )


@dataclass(frozen=True)
class Pull:
    """The pull of eight cables of given lengths whose drums are in balance.

    Attributes:
        tension: T, shape (..., 8) [N].
        angle: φ, positive winds in, shape (..., 8) [rad].
        no_load: d₀, shape (..., 8) [m].
        stiffness: dT/dd, zero where the drum spring is unwound, shape (..., 8) [N/m].
    """

    tension: np.ndarray
    angle: np.ndarray
    no_load: np.ndarray
    stiffness: np.ndarray


def pull(robot: Robot, d: np.ndarray, current: float | np.ndarray = 0.0) -> Pull:
    """Returns tensions at given cable lengths, with constant currents and drums in balance.

    Args:
        robot: its numbers.
        d: cable lengths, shape (..., 8) [m].
        current: of the motors, one number or shape (8,) [A].
    """
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
