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

from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np
from scipy.signal import savgol_filter

from identification.errors import InputError
from inca_mj.kinematics.balance import DRUMS, LENGTHS, PLATFORM, Balance, NoLoad, Weights, balance
from inca_mj.kinematics.elastic import ElasticRobot, Measured, drum_tension, no_load_along
from inca_mj.kinematics.forward import find
from inca_mj.kinematics.inverse_geometry import cables_at
from inca_mj.kinematics.resting import no_load_of
from inca_mj.kinematics.rotations import rotation

Array = np.ndarray

WINDOW = 0.05  # over which rates are taken, but at least five samples [s]
FEWEST = 5  # samples
FIRST_TENSION, FIRST_FORCE = 1.0, 0.3  # where the search for both std begins [N]
LEAST = 1e-3  # smallest std of a tension or force [N]
ROUNDS = 50
STILL = 0.01  # relative change of a std that counts as none
UNUSED = 100.0  # std of a tension where the drum's balance is not used [N]
ENOUGH = 250  # samples by which the std are estimated
PATHS = 2  # times that d₀ is integrated along the path of the tensions
STRIDE = 5  # samples; the poses between begin at the same one
FAR = 0.05  # lengths that no pose meets better than that belong to no pose [m]


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


def measure(
    angles: Array, currents: Array, sampling_time: float, hold: str = "zoh"
) -> tuple[Measured, int]:
    """Angles and currents of a log, with the rates that the angles show.

    Before its first sample the robot rests with all angles zero and no currents.

    Args:
        angles: φ, shape (N, 8) [rad].
        currents: i, shape (N, 8) [A].
        sampling_time: between samples [s].
        hold: "zoh" or "foh", the currents between samples.

    Returns:
        The record, and how many samples at its end have rates that are extrapolated.

    Raises:
        InputError: there are fewer than five samples.
    """
    if len(angles) < FEWEST:
        raise InputError(
            f"{len(angles)} samples are too few to see rates in them; give {FEWEST} or more"
        )
    longest = len(angles) - 1 + len(angles) % 2
    window = min(max(FEWEST, 2 * round(WINDOW / sampling_time / 2) + 1), longest)
    still = np.zeros((window, angles.shape[1]))  # the rest before the log
    φ, i = np.concatenate([still, angles]), np.concatenate([still, currents])
    ω, ω_rate = (
        savgol_filter(φ, window, 2, deriv=k, delta=sampling_time, axis=0)[window:] for k in (1, 2)
    )
    if hold == "zoh":
        i[1:] = (i[1:] + i[:-1]) / 2
    measured = Measured(
        angles=np.asarray(angles), currents=i[window:], rates=ω, rate_changes=ω_rate
    )
    return measured, window // 2


def poses_along(robot: ElasticRobot, measured: Measured, encoder: Array, ends: int) -> Along:
    """Poses and tensions at each sample of a log that begins at rest with all angles zero.

    Args:
        robot: its numbers.
        measured: from `measure`.
        encoder: std of each angle, shape (8,) [rad].
        ends: samples at the end of which the drums' balance is not used.

    Raises:
        InputError: at a sample no pose has such cable lengths.
    """
    ρ = np.linalg.norm(robot.geometry.B, axis=1).mean()
    arm = robot.gyration / ρ
    weights = Weights(
        length=robot.R * encoder,
        tension=np.full_like(measured.angles, FIRST_TENSION),
        force=FIRST_FORCE,
        moment=FIRST_FORCE * arm,
    )
    first: NoLoad = partial(no_load_of, measured.angles)
    found = balance(robot, measured, weights, first, _rigid(robot, measured, weights.length))
    used = np.arange(len(measured.angles)) < len(measured.angles) - ends
    for _ in range(PATHS):
        d_0 = no_load_along(robot, measured.angles, found.tension)
        weights = _components(robot, measured, weights, d_0, found, arm, used)
        begin = found.position, found.R, found.tension
        found = balance(robot, measured, weights, partial(_fixed, d_0), begin)
    missed = found.residual[:, LENGTHS] * weights.length
    _refuse_unreached(missed, np.arange(len(missed)))
    return Along(found=found, measured=measured, weights=weights, no_load_length=d_0)


def no_load_path(angles: Array, path: Array, robot: ElasticRobot, T: Array) -> tuple[Array, Array]:
    """d₀ of another robot along the same path of tensions: its change with the robot's numbers."""
    return no_load_along(robot, angles, path), np.zeros_like(T)


def _fixed(d_0: Array, robot: ElasticRobot, T: Array) -> tuple[Array, Array]:
    return d_0, np.zeros_like(T)


def _components(
    robot: ElasticRobot,
    measured: Measured,
    weights: Weights,
    d_0: Array,
    found: Balance,
    arm: float,
    used: Array,
) -> Weights:
    """The std of drums and platform that the residuals show, by evenly chosen samples."""
    some = np.flatnonzero(used)[:: max(1, used.sum() // ENOUGH)]
    part = Measured(**{f.name: getattr(measured, f.name)[some] for f in fields(measured)})
    begin = found.position[some], found.R[some], found.tension[some]
    σ_T, σ_F = FIRST_TENSION, weights.force
    for _ in range(ROUNDS):
        both = replace(weights, tension=np.full((len(some), 1), σ_T), force=σ_F, moment=σ_F * arm)
        now = balance(robot, part, both, partial(_fixed, d_0[some]), begin)
        begin = now.position, now.R, now.tension
        square, left = now.residual**2, now.redundancy
        scale = [
            float(np.sqrt(square[:, group].sum() / left[:, group].sum()))
            for group in (DRUMS, PLATFORM)
        ]
        σ_T, σ_F = max(LEAST, σ_T * scale[0]), max(LEAST, σ_F * scale[1])
        if np.abs(np.array(scale) - 1).max() < STILL:
            break
    tension = np.where(used[:, None], σ_T, UNUSED) * np.ones_like(weights.tension)
    return replace(weights, tension=tension, force=σ_F, moment=σ_F * arm)


def _rigid(robot: ElasticRobot, measured: Measured, σ: Array) -> tuple[Array, Array, Array]:
    """Poses from the lengths alone, tensions by the drums; some samples in turn, others alike."""
    T = np.maximum(drum_tension(robot, measured), 0)
    d_0, _ = no_load_of(measured.angles, robot, T)
    lengths = d_0 * (1 + T / robot.lambda_)
    position, R = robot.pose[:3], rotation(*robot.pose[3:])
    positions, rotations = np.empty((len(T), 3)), np.empty((len(T), 3, 3))
    for k in range(0, len(T), STRIDE):
        position, R, _ = find(lengths[k], robot.geometry, (position, R), σ, tolerance=1e-6)
        missed = cables_at(position, R, robot.geometry).lengths - lengths[k]
        _refuse_unreached(missed[None], np.array([k]))
        positions[k : k + STRIDE], rotations[k : k + STRIDE] = position, R
    return positions, rotations, T


def _refuse_unreached(missed: Array, samples: Array) -> None:
    """Refuse lengths that no pose has; their errors have shape (n, 8) [m].

    Raises:
        InputError: an error is larger than `FAR`.
    """
    n, k = np.unravel_index(np.abs(missed).argmax(), missed.shape)
    if abs(missed[n, k]) > FAR:
        raise InputError(
            f"no pose has the cable lengths of sample {samples[n]}: the nearest one misses cable"
            f" {k + 1} by {abs(missed[n, k]):.3g} m; check the geometry, the start pose and the"
            " sign of the angles (positive winds in)"
        )
