"""The pose along a log of motor angles and currents, with its std at each sample.

Each sample is a measurement of its own (`inca_mj.kinematics.balance`). Its drums are balanced with
the rates and accelerations that the angles themselves show: ω and ω̇ are derivatives of a
polynomial of degree 2 over five samples or 50 ms (Savitzky and Golay 1964), and the current is
averaged over the two that act just before and just after the sample. What that leaves open of a
drum has the unknown std σ_T, and the acceleration of the platform, which is neglected, the unknown
std σ_F. Both are estimated from the residuals of the whole log, as variance components (Förstner
1979):

    σ² ← σ² Σ r²/Σ redundancy        until both stay; r in units of σ

The moment has the std σ_F k²/ρ: a platform that shakes as much by turning as by moving, k its
radius of gyration, ρ the mean distance of the connectors. The lengths have the std of the
encoders.

d₀ follows the path: first with the mean strain of both ends, then by the integral of (2.30) with
the tensions that were found."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.signal import savgol_filter

from identification.errors import InputError
from inca_mj.kinematics.balance import DRUMS, PLATFORM, Balance, NoLoad, Weights, balance
from inca_mj.kinematics.elastic import ElasticRobot, Measured, drum_tension, no_load_along
from inca_mj.kinematics.forward import REACH, find
from inca_mj.kinematics.resting import no_load_of
from inca_mj.kinematics.rotations import rotation

Array = np.ndarray

WINDOW = 0.05  # over which rates are taken, but at least five samples [s]
FEWEST = 5  # samples
FIRST_TENSION, FIRST_FORCE = 1.0, 0.3  # where the search for both std begins [N]
LEAST = 1e-3  # smallest std of a tension or force [N]
ROUNDS = 30
STILL = 0.02  # relative change of a std that counts as none


@dataclass(frozen=True, kw_only=True)
class Along:
    """Poses along a log.

    Attributes:
        found: poses, tensions and their covariance at each sample.
        measured: angles, currents, rates and their changes.
        weights: std of the statements, two of them estimated.
        no_load_length: d₀, shape (N, 8) [m].
    """

    found: Balance
    measured: Measured
    weights: Weights
    no_load_length: Array


def measure(angles: Array, currents: Array, sampling_time: float, hold: str = "zoh") -> Measured:
    """Angles and currents of a log, with the rates that the angles show.

    Args:
        angles: φ, shape (N, 8) [rad].
        currents: i, shape (N, 8) [A].
        sampling_time: between samples [s].
        hold: "zoh" or "foh", the currents between samples.

    Raises:
        InputError: there are fewer than five samples.
    """
    if len(angles) < FEWEST:
        raise InputError(
            f"{len(angles)} samples are too few to see rates in them; give {FEWEST} or more"
        )
    longest = len(angles) - 1 + len(angles) % 2
    window = min(max(FEWEST, 2 * round(WINDOW / sampling_time / 2) + 1), longest)
    ω, ω_rate = (
        savgol_filter(angles, window, 2, deriv=k, delta=sampling_time, axis=0) for k in (1, 2)
    )
    i = np.array(currents, float)
    if hold == "zoh":
        i[1:] = (currents[1:] + currents[:-1]) / 2
    return Measured(angles=np.asarray(angles), currents=i, rates=ω, rate_changes=ω_rate)


def poses_along(robot: ElasticRobot, measured: Measured, encoder: float) -> Along:
    """Poses and tensions at each sample of a log that begins at rest with all angles zero.

    Args:
        robot: its numbers.
        measured: from `measure`.
        encoder: std of each angle [rad].

    Raises:
        InputError: at a sample no pose has such cable lengths.
    """
    ρ = np.linalg.norm(robot.geometry.B, axis=1).mean()
    arm = robot.gyration / ρ
    weights = Weights(
        length=robot.R * encoder,
        tension=np.full(len(robot.R), FIRST_TENSION),
        force=FIRST_FORCE,
        moment=FIRST_FORCE * arm,
    )
    first: NoLoad = partial(no_load_of, measured.angles)
    begin = _rigid(robot, measured, weights.length)
    found = balance(robot, measured, weights, first, begin)
    for _ in range(ROUNDS):
        d_0 = no_load_along(robot, measured.angles, found.tension)
        weights, change = _weighted(weights, found, arm)
        found = balance(robot, measured, weights, partial(_fixed, d_0), (found.position, found.R))
        if change < STILL:
            break
    return Along(found=found, measured=measured, weights=weights, no_load_length=d_0)


def no_load_path(angles: Array, path: Array, robot: ElasticRobot, T: Array) -> tuple[Array, Array]:
    """d₀ of another robot along the same path of tensions: its change with the robot's numbers."""
    return no_load_along(robot, angles, path), np.zeros_like(T)


def _fixed(d_0: Array, robot: ElasticRobot, T: Array) -> tuple[Array, Array]:
    return d_0, np.zeros_like(T)


def _weighted(weights: Weights, found: Balance, arm: float) -> tuple[Weights, float]:
    """The std that the residuals show, and the larger relative change."""
    square, left = found.residual**2, found.redundancy
    scale = [
        float(np.sqrt(square[:, group].sum() / left[:, group].sum())) for group in (DRUMS, PLATFORM)
    ]
    σ_T = max(LEAST, float(weights.tension[0]) * scale[0])
    σ_F = max(LEAST, weights.force * scale[1])
    change = max(abs(σ_T / weights.tension[0] - 1), abs(σ_F / weights.force - 1))
    new = replace(weights, tension=np.full_like(weights.tension, σ_T), force=σ_F, moment=σ_F * arm)
    return new, float(change)


def _rigid(robot: ElasticRobot, measured: Measured, σ: Array) -> tuple[Array, Array]:
    """Poses from the lengths alone, tensions by the drums; each begins at the one before."""
    T = np.maximum(drum_tension(robot, measured), 0)
    d_0, _ = no_load_of(measured.angles, robot, T)
    lengths = d_0 * (1 + T / robot.lambda_)
    pose, R = robot.pose, rotation(*robot.pose[3:])
    position = pose[:3]
    positions, rotations = np.empty((len(T), 3)), np.empty((len(T), 3, 3))
    for k, d in enumerate(lengths):
        position, R, _ = find(d, robot.geometry, (position, R), σ, tolerance=1e-6)
        positions[k], rotations[k] = position, R
    there = np.linalg.norm(
        positions[:, None] + robot.geometry.B @ np.swapaxes(rotations, 1, 2) - robot.geometry.A,
        axis=2,
    )
    missed = np.abs(there - lengths)
    if missed.max() > 5 * REACH:
        n, k = np.unravel_index(missed.argmax(), missed.shape)
        raise InputError(
            f"no pose has the cable lengths of sample {n}: the nearest one misses cable {k + 1} by"
            f" {missed[n, k]:.3g} m; check the geometry, the start pose and the sign of the angles"
            " (positive winds in)"
        )
    return positions, rotations
