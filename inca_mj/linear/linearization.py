"""The robot linearised at a pose where currents hold it, and along a log.

    δẋ = A δx + B δi,   δφ = C δx + D δi        x: the 36 states of the thesis, i currents, φ angles

The friction of a motor is smooth, so it has a slope everywhere, and the slope at rest is special:

    -∂Γ_f/∂ω_m = b_v + b_c β (1 - tanh²(β ω_m))     at ω_m = 0:  b_v + b_c β

With the thesis' values that is 4.2e-3 N m s/rad, of which b_v has 2e-4. A motor that turns faster
than 1/β feels far less: the linear model at rest holds for rates well below 1/β = 1.25 rad/s.

At a pose it is held by its currents, which is a rest:

    T = t₀ + W⁺ (w - W t₀)                  as at the start, for the pose (`inca_mj.twin.statics`)
    d₀ = λ d/(λ + T)                        (thesis 2.24, 2.25)
    φ = (1 + ε̄)(d₀(0) - d₀)/R               what the roller has wound in since the start
    K_t i = R T - R_s F_s(φ)                (thesis 2.40 at rest)

It is one robot everywhere: its drum springs balance the pretension of its own start pose, where
i = 0. φ and d₀ are states of their own, so that any φ is a rest with the right i; the one above is
that of a slow way from the start, with the mean ε̄ of the strains at both ends (thesis 2.30), and
errs by less than 1e-4 of φ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

import numpy as np

from identification.errors import InputError, unknown_name
from identification.linear.gridded import FEWEST, GriddedSystem, check_axis, gridded
from identification.linear.linearization import linearize as linearize_model
from identification.linear.operating_points import OperatingPoints, along_log
from identification.linear.points import Points
from identification.linear.system import LinearSystem
from identification.logs.log import Log
from identification.model.predictor import Predictor
from inca_mj.linear.thesis_states import TENSIONS, to_tension, to_thesis
from inca_mj.robot.geometry import DRIVES, each_drive
from inca_mj.robot.parameters import pose_values
from inca_mj.robot.spread import at_drives
from inca_mj.twin.logs import ANGLES, POSE
from inca_mj.twin.statics import start_from, start_state
from inca_mj.twin.twin import Twin, build_twin

MOTORS, FIRST_ANGLE = slice(6, 6 + DRIVES), 7  # in qvel and qacc; in qpos
STILL = 1e-6  # [m/s², rad/s²]; pretension is exact to 1e-9 N on 1e-4 kg m²
LENGTHS = each_drive("length")
SPEEDS = slice(20, 28)
LARGEST_GRID = 20_000  # points: two minutes and 1 GB


@dataclass(frozen=True, kw_only=True)
class LinearModel:
    """The robot linearised at one operating point.

    Attributes:
        robot: the twin.
        system: continuous, in the 36 states of the thesis.
        tension: of the cables there, shape (8,) [N].
        friction_slope: of each motor there, shape (8,) [N m s/rad].
        time: of the log [s]; None at a pose.
        lengths: the system with the lengths of the cables as outputs [m].
    """

    robot: Twin
    system: LinearSystem
    tension: np.ndarray
    friction_slope: np.ndarray
    time: float | None
    lengths: LinearSystem

    @property
    def with_tensions(self) -> LinearSystem:
        """The system with tensions in the place of no-load lengths, at rest only."""
        return to_tension(self.system, self.lengths, self.robot)


def linearize(
    robot: Twin | None = None,
    pose: Sequence[float] | None = None,
    outputs: Sequence[str] = ANGLES,
) -> LinearModel:
    """Linearise the robot where currents hold it at a pose.

    Args:
        robot: the twin; that of the thesis' Table 3.2 when None.
        pose: x, y, z [m], roll, pitch, yaw [rad]; its start, where the currents are zero, if None.
        outputs: names of the model's sensors.

    Raises:
        InputError: the pose is not six numbers within bounds, a cable would have to push there, the
            robot does not rest there, or an output is no sensor of the model.
        DivergenceError: the accelerations are not finite.
    """
    robot = robot or build_twin()
    values = robot.parameters.values()
    at = [values[name] for name in POSE] if pose is None else pose
    return _models(robot, held_at(robot, [at]), outputs)[0]


def linearize_along(
    robot: Twin, log: Log, times: Sequence[float], outputs: Sequence[str] = ANGLES
) -> tuple[LinearModel, ...]:
    """Linearise the robot along its free run under the currents of a log.

    Args:
        robot: the twin, which begins at its start pose.
        log: of this robot.
        times: of the log [s].
        outputs: names of the model's sensors.

    Raises:
        InputError: a time is outside the log, a cable is slack there, or an output is no sensor of
            the model.
        DivergenceError: the simulation left the finite numbers.
    """
    points = along_log(Predictor(robot, log, (), {}), times)
    models = _models(robot, points, outputs)
    timed = [replace(m, time=float(t)) for m, t in zip(models, points.time, strict=True)]
    for model in timed:
        if slack := [str(k + 1) for k in np.flatnonzero(model.tension <= 0)]:
            raise InputError(
                f"cable {', '.join(slack)} is slack at {model.time:g} s, where the law has a kink"
                " and no linear model holds; take a time at which every cable pulls"
            )
    return tuple(timed)


def linearize_grid(
    robot: Twin,
    axes: Mapping[str, np.ndarray],
    method: Literal["linear", "cubic"] = "cubic",
    outputs: Sequence[str] = ANGLES,
) -> GriddedSystem:
    """Linearise the robot on a grid of poses: an LPV model with tensions among its states.

    Args:
        robot: the twin; where the axes give nothing, its own start pose holds.
        axes: points of some of x, y, z [m], roll, pitch, yaw [rad], each an array of shape (n,).
        method: how to interpolate, "linear" or "cubic".
        outputs: names of the model's sensors.

    Raises:
        InputError: an axis is unknown, does not rise or has too few points, or the robot cannot be
            held at a point of the grid.
        DivergenceError: the accelerations are not finite.
    """
    if method not in FEWEST:
        raise unknown_name("interpolation", method, FEWEST)
    for name, values in axes.items():
        if name not in POSE:
            raise unknown_name("scheduling variable", name, POSE)
        check_axis(name, values, FEWEST[method])
    if not axes:
        raise InputError(f"a grid needs an axis or more of {', '.join(POSE)}")
    size = int(np.prod([len(values) for values in axes.values()]))
    if size > LARGEST_GRID:
        raise InputError(
            f"the grid has {size} points, more than {LARGEST_GRID}; give fewer, and method cubic"
        )
    numbers = robot.parameters.values()
    poses = [
        [dict(zip(axes, point, strict=True)).get(name, numbers[name]) for name in POSE]
        for point in product(*axes.values())
    ]
    models = _models(robot, held_at(robot, poses), outputs)
    return gridded(axes, [model.with_tensions for model in models], method)


def held_at(robot: Twin, poses: Sequence[Sequence[float]]) -> OperatingPoints:
    """Returns the robot at rest at some poses, with the currents that hold it there.

    Args:
        robot: the twin; its own start pose is that of its springs.
        poses: x, y, z [m], roll, pitch, yaw [rad], M of them.

    Raises:
        InputError: a pose is not six numbers within the robot's bounds, a cable would have to push
            there, or the cables cannot hold the platform.
        DivergenceError: the accelerations are not finite.
    """
    starts = [_start(robot, pose) for pose in poses]
    start = robot.start
    R = at_drives("R", robot.parameters.values())
    states = [start_state(begin) for begin in starts]
    qpos = np.array([s.qpos for s in states])
    for row, begin in zip(qpos, starts, strict=True):
        ε = (start.strain + begin.strain) / 2
        row[FIRST_ANGLE:] = (1 + ε) * (start.no_load_length - begin.no_load_length) / R
    robot.state()  # its law is installed
    point = OperatingPoints(
        model=robot.model,
        qpos=qpos,
        qvel=np.array([s.qvel for s in states]),
        act=np.array([s.act for s in states]),
        inputs=np.zeros((len(states), DRIVES)),
        time=np.zeros(len(states)),
    )
    at = Points(point)
    without, ones = at.rates(), at.rates(ctrl=np.ones_like(point.inputs))
    i = -without[:, MOTORS] / (ones - without)[:, MOTORS]
    _refuse_moving(at.rates(ctrl=i), poses)
    return replace(point, inputs=i)


def _start(robot: Twin, pose: Sequence[float]):
    values = robot.parameters.with_values(pose_values(pose)).values()
    return start_from(values, robot.geometry, robot.layout)


def _refuse_moving(rates: np.ndarray, poses: Sequence[Sequence[float]]) -> None:
    """Refuse states that do not rest under their currents."""
    moving = np.abs(rates[:, : MOTORS.stop]).max(axis=1)
    worst = int(moving.argmax())
    if not moving[worst] < STILL:
        raise InputError(
            f"the robot does not rest at pose {np.round(poses[worst], 4).tolist()}: an acceleration"
            f" of {moving[worst]:.3g} is left, because its effects act on the platform; build it"
            " with settled=True, or without them"
        )


def _models(
    robot: Twin, points: OperatingPoints, outputs: Sequence[str]
) -> tuple[LinearModel, ...]:
    """Returns the models at some operating points; their times are not set."""
    sensors = (*outputs, *LENGTHS, *TENSIONS)
    systems = to_thesis(linearize_model(points, sensors), points, robot.layout.states - 1)
    p = robot.parameters.values()
    b_v, b_c, β = (at_drives(name, p) for name in ("b_v", "b_c", "beta"))
    out = []
    for system in systems:
        shown, lengths, tension = _parted(system)
        slope = b_v + b_c * β / np.cosh(β * system.x[SPEEDS]) ** 2
        out.append(
            LinearModel(robot=robot, system=shown, tension=tension.y, friction_slope=slope,
                        time=None, lengths=lengths)
        )  # fmt: skip
    return tuple(out)


def _parted(system: LinearSystem) -> tuple[LinearSystem, LinearSystem, LinearSystem]:
    """Returns a system parted by its outputs: those asked for, cable lengths and cable tensions."""
    n = len(system.outputs)
    cuts = (slice(0, n - 2 * DRIVES), slice(n - 2 * DRIVES, n - DRIVES), slice(n - DRIVES, n))
    first, second, third = (
        replace(system, C=system.C[cut], D=system.D[cut], y=system.y[cut],
                outputs=system.outputs[cut])
        for cut in cuts
    )  # fmt: skip
    return first, second, third
