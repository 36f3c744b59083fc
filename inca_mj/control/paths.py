"""The wanted motion of the platform: a point, line or circle, with velocity and acceleration.

    circle    p = c + r S(t/T) (cos θ, sin θ) in its plane,    θ̇ = Ω S(t/T - 1)
    line      p = p₀ + (p₁ - p₀) S(t/T)
    S(x) = 10 x³ - 15 x⁴ + 6 x⁵, 0 before and 1 after      (Flash, Hogan 1985: least jerk)

The platform stays upright. Every path starts at rest, so that a robot at rest can follow it from
the beginning; velocity and acceleration have no jumps.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, isfinite, sin
from typing import Protocol

import numpy as np

from identification.errors import InputError, unknown_name

PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}  # the axes that cos θ and sin θ lie along


@dataclass(frozen=True)
class Motion:
    """The wanted place of the platform at one time, and its wanted motion there."""

    position: np.ndarray  # in O, shape (3,) [m]
    velocity: np.ndarray  # shape (3,) [m/s]
    acceleration: np.ndarray  # shape (3,) [m/s²]


class Path(Protocol):
    """A motion of the platform over time."""

    def at(self, time: float) -> Motion:
        """Returns the motion at a time [s] since the start."""
        ...


@dataclass(frozen=True)
class Point:
    """The platform stays where it is.

    Attributes:
        position: in O, three numbers [m].
    """

    position: tuple[float, float, float]

    def at(self, time: float) -> Motion:
        """Returns the motion at a time [s] since the start."""
        return Motion(np.array(self.position), np.zeros(3), np.zeros(3))


@dataclass(frozen=True)
class Line:
    """A straight line from one point to another, with least jerk.

    Attributes:
        begin: in O, three numbers [m].
        end: in O, three numbers [m].
        duration: of the way [s].

    Raises:
        InputError: the duration is not positive.
    """

    begin: tuple[float, float, float]
    end: tuple[float, float, float]
    duration: float = 1.5

    def __post_init__(self) -> None:
        _refuse_small("duration", self.duration, "s")

    def at(self, time: float) -> Motion:
        """Returns the motion at a time [s] since the start."""
        way = np.array(self.end) - self.begin
        _, s, s_1, s_2 = smooth_step(time / self.duration)
        T = self.duration
        return Motion(self.begin + way * s, way * s_1 / T, way * s_2 / T**2)


@dataclass(frozen=True, kw_only=True)
class Circle:
    """A circle, begun at rest in its centre: out on a radius, then round with growing rate.

    Attributes:
        centre: in O, three numbers [m].
        radius: of the circle [m].
        rate: Ω, after the start [rad/s].
        ramp: T, of the way out, and as long again until the full rate is reached [s].
        plane: "xy", "xz" or "yz".
        phase: θ of the way out [rad].

    Raises:
        InputError: radius, rate or ramp is not positive, or there is no such plane.
    """

    centre: tuple[float, float, float] = (0.0, 0.0, 1.43)
    radius: float = 0.3
    rate: float = 1.0
    ramp: float = 2.0
    plane: str = "xy"
    phase: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("radius", "m"), ("rate", "rad/s"), ("ramp", "s")):
            _refuse_small(name, getattr(self, name), unit)
        if self.plane not in PLANES:
            raise unknown_name("plane", self.plane, PLANES)

    def at(self, time: float) -> Motion:
        """Returns the motion at a time [s] since the start."""
        _, out, out_1, out_2 = smooth_step(time / self.ramp)
        area, s, s_1, _ = smooth_step(time / self.ramp - 1)
        θ = self.phase + self.rate * self.ramp * area
        θ_1, θ_2 = self.rate * s, self.rate * s_1 / self.ramp
        r, r_1, r_2 = (self.radius * x / self.ramp**n for n, x in enumerate((out, out_1, out_2)))
        along, across = np.zeros(3), np.zeros(3)
        first, second = PLANES[self.plane]
        along[[first, second]] = cos(θ), sin(θ)
        across[[first, second]] = -sin(θ), cos(θ)
        return Motion(
            position=self.centre + r * along,
            velocity=r_1 * along + r * θ_1 * across,
            acceleration=(r_2 - r * θ_1**2) * along + (r * θ_2 + 2 * r_1 * θ_1) * across,
        )

    @property
    def full(self) -> float:
        """The time from which on the platform goes round at the full rate [s]."""
        return 2 * self.ramp


def smooth_step(x: float) -> tuple[float, float, float, float]:
    """Returns ∫S dx from 0, S, S' and S'' at x."""
    if x <= 0:
        return 0.0, 0.0, 0.0, 0.0
    if x >= 1:
        return x - 0.5, 1.0, 0.0, 0.0
    return (
        x**4 * (2.5 - 3 * x + x**2),
        x**3 * (10 - 15 * x + 6 * x**2),
        30 * x**2 * (1 - x) ** 2,
        60 * x * (1 - x) * (1 - 2 * x),
    )


def _refuse_small(name: str, value: float, unit: str) -> None:
    if not (isfinite(value) and value > 0):
        raise InputError(f"a path with a {name} of {value:g} {unit}; give a positive one")
