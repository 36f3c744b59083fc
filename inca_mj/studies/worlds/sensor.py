"""Encoders: how they read an angle, and faults that hide the angle φ of a motor.

y = Δ round((φ + σ w)/Δ),  Δ = 2π/counts,  w white       rms √(σ² + Δ²/12)
e_k+1 = a e_k + √(1 − a²) e_rms w,  a = e^(−T_s/τ)       error of a current, stationary low-pass

scale           s φ                                      counts a turn are not what they are
eccentricity    a cos φ + b sin φ                        the disc turns about another centre
lag             x − φ, τ ẋ = φ − x;  φ(t − τ) − φ        filtered, or read too late where `late`
jump            c from t_s on                            counts are lost

The robot moves as if faulty encoders were right. Between the samples φ is the cubic that has their
angles and rates. The lag is exact where φ is straight over `FINE` of a sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from inca_mj.reference import layout as base
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenEffect,
    HiddenOneDriveEffect,
    kind,
    size,
)
from inca_mj.studies.worlds.plant import HiddenPlant, simulate_world


def encode(angles: np.ndarray, counts: int, noise: float, rng: np.random.Generator) -> np.ndarray:
    """Returns true angles [rad] as encoders of some counts a turn give them; 0 has no steps.

    The noise is white before the rounding; it is given by its rms [rad].
    """
    y = angles + noise * rng.normal(size=angles.shape)
    if counts == 0:
        return y
    Δ = 2 * np.pi / counts
    return Δ * np.round(y / Δ)


def noise_rms(counts: int, noise: float) -> float:
    """Returns the rms of the measurement noise [rad]."""
    Δ = 2 * np.pi / counts if counts else 0.0
    return float(np.sqrt(noise**2 + Δ**2 / 12))


def coloured(
    shape: tuple[int, int], sampling_time: float, rms: float, time: float, rng: np.random.Generator
) -> np.ndarray:
    """Returns an error of the currents [A] of a shape (n, 8), independent by column.

    It is white noise of some rms [A] behind a low-pass of the time constant τ [s], 0 for none.
    """
    w = rms * rng.normal(size=shape)
    a = float(np.exp(-sampling_time / time)) if time > 0 else 0.0
    e = np.empty(shape)
    e[0] = w[0]
    for k in range(1, shape[0]):
        e[k] = a * e[k - 1] + np.sqrt(1 - a**2) * w[k]
    return e


FINE = 100  # parts of a sample in which an angle is straight
BETWEEN = 5  # simulated states a sample, where angles between samples are asked for


@dataclass(frozen=True)
class Motion:
    """The motion of the motors."""

    time: np.ndarray  # of the samples, shape (n,) [s]
    angles: np.ndarray  # at the samples, shape (n, k) [rad]
    between: CubicHermiteSpline  # the angles at any time, at rest before the first sample

    def at(self, time: np.ndarray) -> np.ndarray:
        """Returns angles at any times, shape (m, k) [rad]."""
        return np.asarray(self.between(np.clip(time, self.time[0], self.time[-1])))


class HiddenEncoderFault(HiddenDriveEffect):
    """A fault that an encoder adds to the angle; it changes nothing of the robot."""

    def added(self, motion: Motion) -> np.ndarray:
        """Returns what the encoders add if all have the fault, shape (n, k) [rad]."""
        raise NotImplementedError


class HiddenOneEncoderFault(HiddenOneDriveEffect, HiddenEncoderFault):
    """A fault of one encoder."""


@dataclass(frozen=True, kw_only=True)
class HiddenEncoderLag(HiddenEncoderFault):
    """x − φ with τ ẋ = φ − x, or φ(t − τ) − φ where `late`; τ [s]."""

    name = "encoder_lag"
    largest = 0.02
    tau: float = size(2e-3)
    late: bool = False

    def added(self, motion: Motion) -> np.ndarray:
        """Returns the read angle less the true one, shape (n, k) [rad]."""
        if self.late:
            return motion.at(motion.time - self.tau) - motion.angles
        return lagged(motion, self.tau) - motion.angles


def _jumped(fault: Any, motion: Motion) -> np.ndarray:
    """Returns what a jump adds, c where t ≥ t_s, shape (n, k) [rad]."""
    late = motion.time >= fault.t_s - 1e-9
    return np.asarray(fault.c * np.repeat(late[:, None], motion.angles.shape[1], axis=1))


KINDS = (
    kind("encoder_scale", HiddenOneEncoderFault, 0.05, s=size(0.003),
         added=lambda fault, motion: fault.s * motion.angles),
    # a disc that is off its centre by a twentieth of its radius; a, b [rad]
    kind("encoder_eccentricity", HiddenOneEncoderFault, 0.05, a=size(0.005), b=size(0.005),
         added=lambda fault, motion: (
             fault.a * np.cos(motion.angles) + fault.b * np.sin(motion.angles))),
    HiddenEncoderLag,
    kind("encoder_jump", HiddenOneEncoderFault, 0.5, c=size(0.02), t_s=field(default=0.5),
         added=_jumped),
)  # fmt: skip


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

    The plant was made with the same effects, of which those of encoders count here. Arguments and
    refusals are otherwise those of `simulate_world`.
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
