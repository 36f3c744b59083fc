"""The numbers of a robot with elastic cables whose drum springs balance its start pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY, POSE
from inca_mj.robot.spread import at_drives, displaced


@dataclass(frozen=True, kw_only=True)
class Robot:
    """A robot that rests at its start pose; arrays have one entry for each drive.

    Attributes:
        geometry: where the anchors are, displacements included.
        start: pose where all motor angles are zero, shape (6,) [m, rad].
        tension: T(0), tensions there, shape (8,) [N].
        no_load: d₀(0), no-load lengths there, shape (8,) [m].
        m: mass of the platform [kg].
        I: its principal inertias about body axes, shape (3,) [kg m^2].
        lambda_: elastic modulus λ of the cables, shape (8,) [N].
        R: radius of the rollers, shape (8,) [m].
        R_s: radius of the spring drums, shape (8,) [m].
        k_s: constant of the drum springs, shape (8,) [N/m].
        K_t: torque constants, shape (8,) [N m/A].
        J: inertia of the motors, shape (8,) [kg m^2].
        b_v: viscous friction of the motors, shape (8,) [N m s/rad].
        b_c: Coulomb friction of the motors, shape (8,) [N m].
        beta: its smoothness, shape (8,) [s/rad].
    """

    geometry: Geometry
    start: np.ndarray
    tension: np.ndarray
    no_load: np.ndarray
    m: float
    I: np.ndarray
    lambda_: np.ndarray
    R: np.ndarray
    R_s: np.ndarray
    k_s: np.ndarray
    K_t: np.ndarray
    J: np.ndarray
    b_v: np.ndarray
    b_c: np.ndarray
    beta: np.ndarray

    @property
    def weight(self) -> np.ndarray:
        """Wrench w that the cables exert to carry the platform, in O, shape (6,) [N, N m]."""
        return np.array([0, 0, self.m * GRAVITY, 0, 0, 0])

    @property
    def gyration(self) -> float:
        """Mean radius of gyration of the platform, squared [m^2]."""
        return float(sum(self.I) / (3 * self.m))

    @property
    def drum(self) -> np.ndarray:
        """κ = k_s R_s²/R, tension that a drum spring loses per turn, shape (8,) [N/rad]."""
        return self.k_s * self.R_s**2 / self.R

    @property
    def friction_std(self) -> np.ndarray:
        """Std of the tensions by dry friction at rest, b_c/(√3 R), shape (8,) [N]."""
        return self.b_c / (np.sqrt(3) * self.R)


def robot_of(
    values: Mapping[str, float], geometry: Geometry, tension: np.ndarray, no_load: np.ndarray
) -> Robot:
    """Returns the robot of plain values by name in SI units, with T(0) [N] and d₀(0) [m]."""
    each = ("R", "R_s", "k_s", "K_t", "J", "b_v", "b_c", "beta")
    return Robot(
        geometry=displaced(geometry, values),
        start=np.array([values[name] for name in POSE]),
        tension=tension,
        no_load=no_load,
        m=values["m"],
        I=np.array([values[f"I_{axis}"] for axis in "xyz"]),
        lambda_=at_drives("lambda", values),
        **{name: at_drives(name, values) for name in each},
    )
