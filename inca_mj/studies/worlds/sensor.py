"""Encoders that do not tell the angle φ of their motor; the robot moves as if they were right.

scale           s φ                                      counts a turn are not what they are
eccentricity    a cos φ + b sin φ                        the disc turns about another centre
lag             x − φ, τ ẋ = φ − x;  φ(t − τ) − φ        filtered, or read too late where `late`
jump            c from t_s on                            counts are lost

Between the samples φ is the cubic that has their angles and rates. The lag is exact where φ is
straight over `FINE` of a sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from inca_mj.reference import layout as base
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenEffect,
    HiddenNumbers,
    HiddenOneDriveEffect,
)
from inca_mj.studies.worlds.plant import HiddenPlant, simulate_world

FINE = 100  # parts of a sample in which an angle is straight
BETWEEN = 5  # simulated states a sample, where angles between samples are asked for


@dataclass(frozen=True)
class Motion:
    """The motion of the motors.

    Attributes:
        time: of the samples, shape (n,) [s].
        angles: at the samples, shape (n, k) [rad].
        between: the angles at any time, at rest before the first sample.
    """

    time: np.ndarray
    angles: np.ndarray
    between: CubicHermiteSpline

    def at(self, time: np.ndarray) -> np.ndarray:
        """Returns angles at any times, shape (m, k) [rad]."""
        return np.asarray(self.between(np.clip(time, self.time[0], self.time[-1])))


class HiddenEncoderFault(HiddenDriveEffect):
    """A fault that an encoder adds to the angle; it changes nothing of the robot."""

    def put(self, numbers: HiddenNumbers) -> None:
        """Change nothing."""

    def added(self, motion: Motion) -> np.ndarray:
        """Returns what the encoders add if all have the fault, shape (n, k) [rad]."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class HiddenEncoderScale(HiddenOneDriveEffect, HiddenEncoderFault):
    """s φ."""

    name: ClassVar[str] = "encoder_scale"
    sizes: ClassVar[tuple[str, ...]] = ("s",)
    largest: ClassVar[float] = 0.05
    s: float = 0.003

    def added(self, motion: Motion) -> np.ndarray:
        """Returns what the scale adds, s φ, shape (n, k) [rad]."""
        return self.s * motion.angles


@dataclass(frozen=True, kw_only=True)
class HiddenEncoderEccentricity(HiddenOneDriveEffect, HiddenEncoderFault):
    """a cos φ + b sin φ; a, b [rad]."""

    name: ClassVar[str] = "encoder_eccentricity"
    sizes: ClassVar[tuple[str, ...]] = ("a", "b")
    largest: ClassVar[float] = 0.05  # a disc that is off its centre by a twentieth of its radius
    a: float = 0.005
    b: float = 0.005

    def added(self, motion: Motion) -> np.ndarray:
        """Returns what the eccentric disc adds, a cos φ + b sin φ, shape (n, k) [rad]."""
        return np.asarray(self.a * np.cos(motion.angles) + self.b * np.sin(motion.angles))


@dataclass(frozen=True, kw_only=True)
class HiddenEncoderLag(HiddenEncoderFault):
    """x − φ with τ ẋ = φ − x, or φ(t − τ) − φ where `late`; τ [s]."""

    name: ClassVar[str] = "encoder_lag"
    sizes: ClassVar[tuple[str, ...]] = ("tau",)
    largest: ClassVar[float] = 0.02
    tau: float = 2e-3
    late: bool = False

    def added(self, motion: Motion) -> np.ndarray:
        """Returns the read angle less the true one, shape (n, k) [rad]."""
        if self.late:
            return motion.at(motion.time - self.tau) - motion.angles
        return lagged(motion, self.tau) - motion.angles


@dataclass(frozen=True, kw_only=True)
class HiddenEncoderJump(HiddenOneDriveEffect, HiddenEncoderFault):
    """c [rad] from t_s [s] on."""

    name: ClassVar[str] = "encoder_jump"
    sizes: ClassVar[tuple[str, ...]] = ("c",)
    largest: ClassVar[float] = 0.5
    c: float = 0.02
    t_s: float = 0.5

    def added(self, motion: Motion) -> np.ndarray:
        """Returns what the jump adds, c where t ≥ t_s, shape (n, k) [rad]."""
        late = motion.time >= self.t_s - 1e-9
        return self.c * np.repeat(late[:, None], motion.angles.shape[1], axis=1)


def lagged(motion: Motion, tau: float) -> np.ndarray:
    """Returns x of τ ẋ = φ − x from rest, exact where φ is straight, shape (n, k) [rad]."""
    if tau == 0.0:
        return motion.angles
    n = (len(motion.time) - 1) * FINE
    time = np.linspace(motion.time[0], motion.time[-1], n + 1)
    φ, h = motion.at(time), float(time[1] - time[0])
    rate, keeps = np.diff(φ, axis=0) / h, float(np.exp(-h / tau))
    out, e = [motion.angles[0]], np.zeros(φ.shape[1])  # e = x − φ, −τ φ̇ where it has settled
    for k in range(n):
        e = (e + tau * rate[k]) * keeps - tau * rate[k]
        if (k + 1) % FINE == 0:
            out.append(φ[k + 1] + e)
    return np.stack(out)


def simulate_angles(
    plant: HiddenPlant,
    effects: Sequence[HiddenEffect],
    currents: np.ndarray,
    sampling_time: float,
    step: float | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Returns angles of the motors, and what their encoders read without noise, each (n, 8) [rad].

    Args:
        plant: from `make_plant`, with the same effects.
        effects: all, of which those of encoders count here.
        currents: held from sample to sample, shape (n, 8) [A].
        sampling_time: between samples [s].
        step: as of `simulate_world`.

    Raises:
        InputError: as `simulate_world`.
        DivergenceError: as `simulate_world`.
    """
    faults = [e for e in effects if isinstance(e, HiddenEncoderFault)]
    every = BETWEEN if any(isinstance(e, HiddenEncoderLag) for e in faults) else 1
    fine = sampling_time / every
    X = simulate_world(plant, np.repeat(currents, every, axis=0), fine, step)
    X = X[: (len(currents) - 1) * every + 1]
    angles = X[::every, base.ANGLES].copy()
    if not faults:
        return angles, angles
    time = fine * np.arange(len(X))
    between = CubicHermiteSpline(time, X[:, base.ANGLES], X[:, base.SPEEDS]) if len(X) > 1 else None
    motion = Motion(time[::every], angles, between)
    read = angles.copy()
    for fault in faults:
        rows = slice(None) if fault.drive is None else slice(fault.drive - 1, fault.drive)
        read[:, rows] += fault.added(motion)[:, rows]
    return angles, read
