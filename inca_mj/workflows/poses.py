"""The pose of the platform by the motors: of a robot at rest, and along a log, with std.

    std² = noise² + Σ_p (∂pose/∂p σ_p)²

The noise is that of encoders, friction and neglected accelerations (`inca_mj.kinematics.balance`).
The sum is over parameters p that are known with a std σ_p only, those of the start pose included:
T(0) and d₀(0) move with them. Its derivatives are those of the least squares at the solution,
∂pose/∂p = -(JᵀJ)⁻¹ Jᵀ ∂r/∂p, by central differences of the residuals r. An error of a parameter
moves all samples together; the noise moves each by itself, except that the errors of neighbouring
samples by neglected accelerations are alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from identification import InputError, Log, noise_floor
from identification.errors import unknown_name
from identification.model.parameter import ParameterSet
from inca_mj.kinematics.along import measure, no_load_path, poses_along
from inca_mj.kinematics.balance import (
    Balance,
    Measured,
    NoLoad,
    Weights,
    no_load_at_rest,
    statements,
)
from inca_mj.kinematics.resting import ENCODER, at_rest, rest_pose
from inca_mj.robot.elastic import Robot, robot_of
from inca_mj.robot.geometry import DRIVES, INCA, Geometry
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.logs import pose_of
from inca_mj.twin.statics import start_from

STEP = 0.01  # of a difference, in std of the parameter
FINEST = 1e-5  # least std of an encoder: a simulated log has none [rad]


@dataclass(frozen=True, kw_only=True)
class RestingPose:
    """A robot at rest, from its motor angles.

    Attributes:
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        std: of the pose, by noise and parameters, shape (6,) [m, rad].
        noise_std: the part of the noise, shape (6,) [m, rad].
        tension: of the cables, shape (8,) [N].
        tension_std: by noise and parameters, shape (8,) [N].
        no_load_length: d₀, shape (8,) [m].
        residual: lengths of the pose minus those of the elastic cables, shape (8,) [m].
    """

    pose: np.ndarray
    std: np.ndarray
    noise_std: np.ndarray
    tension: np.ndarray
    tension_std: np.ndarray
    no_load_length: np.ndarray
    residual: np.ndarray


@dataclass(frozen=True, kw_only=True)
class LogPoses:
    """Poses along a log of N samples.

    Attributes:
        log: the log.
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (N, 6).
        std: of the pose, by noise and parameters, shape (N, 6) [m, rad].
        noise_std: the part of the noise, shape (N, 6) [m, rad].
        tension: of the cables, shape (N, 8) [N].
        tension_std: by noise and parameters, shape (N, 8) [N].
        taut: False where a cable is slack, shape (N, 8), bool.
        encoder: std of each angle, shape (8,) [rad].
        encoder_length: std of each length by its encoder, shape (8,) [m].
        length_error: std of what geometry and parameters leave open of the lengths [m]; zero
            where it is not told from the noise of the encoders.
        tension_error: std of what the balances of the drums leave open [N].
        force_error: std of the neglected force that accelerates the platform [N].
        measured: pose that the log holds, shape (N, 6) [m, rad]; None where it holds none.
    """

    log: Log
    pose: np.ndarray
    std: np.ndarray
    noise_std: np.ndarray
    tension: np.ndarray
    tension_std: np.ndarray
    taut: np.ndarray
    encoder: np.ndarray
    encoder_length: np.ndarray
    length_error: float
    tension_error: float
    force_error: float
    measured: np.ndarray | None


def pose_at_rest(
    angles: np.ndarray,
    currents: np.ndarray | None = None,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    encoder: float = ENCODER,
    std: Mapping[str, float] | None = None,
) -> RestingPose:
    """Returns the pose of a robot at rest from its motor angles, through elastic cables.

    Args:
        angles: φ, zero where the robot stood at its start pose, shape (8,) [rad].
        currents: shape (8,) [A]; zero when None.
        parameters: the robot's values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        encoder: std of each angle [rad].
        std: of parameters by name, in their units: also those of the start pose (x … yaw), of
            single drives (`R@3`) and of points (`exit_x@3`).

    Raises:
        InputError: no pose at rest has such angles, a cable is slack there, an argument is no such
            number, or the start has no pretension.
    """
    values = (parameters or parameter_set()).values()
    known = _known(parameters or parameter_set(), std or {})
    if not (np.isfinite(encoder) and encoder > 0):
        raise InputError(f"the std of an encoder must be above zero [rad], not {encoder:g}")
    measured = at_rest(angles, np.zeros(DRIVES) if currents is None else currents)
    robot = _robot(values, geometry)
    found, weights = rest_pose(robot, measured, encoder)
    no_load = partial(no_load_at_rest, measured.angles)
    spread = _by_parameters(values, geometry, known, measured, weights, no_load, found)
    noise = _noise(found)
    both = np.sqrt(noise**2 + spread**2)[0]
    d_0, _ = no_load_at_rest(measured.angles, robot, found.tension)
    return RestingPose(
        pose=found.pose[0], std=both[:6], noise_std=noise[0, :6], tension=found.tension[0],
        tension_std=both[6:], no_load_length=d_0[0],
        residual=found.residual[0, :DRIVES] * weights.length,
    )  # fmt: skip


def log_poses(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    encoder: float | None = None,
    std: Mapping[str, float] | None = None,
    progress: Callable[[str], None] | None = None,
) -> LogPoses:
    """Returns the pose along a log from motor angles and currents, with its std at each sample.

    Args:
        log: of the robot, which begins at rest at its start pose with all angles zero.
        parameters: the robot's values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        encoder: std of each angle [rad]; what is seen in the log when None.
        std: of parameters by name, in their units, as in `pose_at_rest`.
        progress: is told what is done, in a sentence.

    Raises:
        InputError: at a sample no pose has such angles, an argument is no such number, or the start
            has no pretension.
    """
    values = (parameters or parameter_set()).values()
    known = _known(parameters or parameter_set(), std or {})
    if encoder is not None and not (np.isfinite(encoder) and encoder > 0):
        raise InputError(f"the std of an encoder must be above zero [rad], not {encoder:g}")
    seen = noise_floor(log.outputs) if encoder is None else np.full(DRIVES, encoder)
    σ = np.maximum(seen, FINEST)
    measured, ends = measure(log.outputs, log.inputs, log.sampling_time, log.hold)
    if progress is not None:
        progress(f"{len(log)} samples, each a pose and eight tensions")
    robot = _robot(values, geometry)
    along = poses_along(robot, measured, σ, ends)
    found, noise = along.found, _noise(along.found)
    path = partial(no_load_path, measured.angles, found.tension)
    spread = _by_parameters(values, geometry, known, measured, along.weights, path, found)
    both = np.sqrt(noise**2 + spread**2)
    return LogPoses(
        log=log, pose=found.pose, std=both[:, :6], noise_std=noise[:, :6], tension=found.tension,
        tension_std=both[:, 6:], taut=found.taut, encoder=σ, encoder_length=robot.R * σ,
        length_error=along.std.length, tension_error=along.std.tension, force_error=along.std.force,
        measured=pose_of(log),
    )  # fmt: skip


def _robot(values: Mapping[str, float], geometry: Geometry) -> Robot:
    begin = start_from(values, geometry)
    return robot_of(values, geometry, begin.tension, begin.no_load_length)


def _noise(found: Balance) -> np.ndarray:
    """Returns the std of pose and tensions by noise, shape (N, 14)."""
    pose = np.diagonal(found.pose_covariance, axis1=1, axis2=2)
    tension = np.diagonal(found.covariance, axis1=1, axis2=2)[:, 6:]
    return np.sqrt(np.hstack([pose, tension]))


def _by_parameters(
    values: Mapping[str, float],
    geometry: Geometry,
    known: Mapping[str, float],
    measured: Measured,
    weights: Weights,
    no_load: NoLoad,
    found: Balance,
) -> np.ndarray:
    """Returns the std of pose and tensions by parameters, shape (N, 14)."""
    square = np.zeros((len(found.tension), 14))
    at = found.position, found.R, found.tension
    for name, σ in known.items():
        sides = []
        for sign in (1, -1):
            moved = {**values, name: values.get(name, 0.0) + sign * STEP * σ}
            robot = _robot(moved, geometry)
            sides.append(statements(robot, measured, weights, no_load, at, found.taut)[0])
        square += found.shift((sides[0] - sides[1]) / (2 * STEP)) ** 2
    return np.sqrt(square)


def _known(parameters: ParameterSet, std: Mapping[str, float]) -> Mapping[str, float]:
    """Returns the std that are above zero, or refuses an unknown name or no std."""
    names = [p.name for p in with_spread(parameters)]
    for name, value in std.items():
        if name not in names:
            raise unknown_name("parameter", name, (n for n in names if "@" not in n))
        if not (np.isfinite(value) and value >= 0):
            raise InputError(f"the std of {name} must be 0 or more, not {value:g}")
    return {name: float(value) for name, value in std.items() if value > 0}
