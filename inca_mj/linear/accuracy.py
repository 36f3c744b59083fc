"""The errors of a gridded model: of its interpolation, and of its predictions of the twin.

At points off the grid, beside the twin's own linearisation there:

    e_A = ‖A - Â‖/‖A‖                                                    Frobenius
    e_G = max over f of ‖G(f) - Ĝ(f)‖/‖G(f)‖,   G = C (s I - A)⁻¹ B + D       currents to angles
    e_f = max over modes of |λ - λ̂|/|λ|                                    without those of zero

and under small PRBS currents about those that hold the robot at such a point, beside the nonlinear
twin: rms of the difference of the angles, relative to that of their motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.linear.gridded import GriddedSystem
from identification.linear.modes import modes
from identification.linear.system import LinearSystem
from identification.model.rollout import State
from inca_mj.linear.linearization import held_at, linearize
from inca_mj.robot.inputs import prbs, sampling_time_of
from inca_mj.twin.logs import POSE
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin

BAND = np.geomspace(0.01, 200.0, 60)  # [Hz] from the drum springs' time constant to the cables'


@dataclass(frozen=True, kw_only=True)
class InterpolationError:
    """Errors of a gridded model at one point off its grid; see the module.

    Attributes:
        point: values of the scheduling variables by name.
        matrix: e_A.
        response: e_G.
        eigenvalue: e_f.
    """

    point: dict[str, float]
    matrix: float
    response: float
    eigenvalue: float


@dataclass(frozen=True, kw_only=True)
class RunError:
    """Errors of models that predict the twin under a small PRBS about one point off the grid.

    Attributes:
        point: values of the scheduling variables by name.
        amplitude: half the step between both levels of each current [A].
        motion: rms of the angles about their start [rad].
        scheduled: rms error of the gridded model, scheduled by the platform's position, relative to
            the motion; NaN where it leaves the grid.
        fixed: the same of the twin's own linearisation at the start.
        travel: largest distance of the platform from its start [m].
    """

    point: dict[str, float]
    amplitude: float
    motion: float
    scheduled: float
    fixed: float
    travel: float


def interpolation_errors(
    robot: Twin, grid: GriddedSystem, points: int = 30, seed: int = 0
) -> tuple[InterpolationError, ...]:
    """Returns errors of a gridded model at random points within its grid.

    Args:
        robot: the twin that it is a model of.
        grid: of `linearize_grid`.
        points: how many.
        seed: of the points.

    Raises:
        InputError: the robot cannot be held at one of them.
        DivergenceError: the accelerations are not finite.
    """
    out = []
    for point in random_points(grid, points, seed):
        exact, other = linearize(robot, _pose(robot, point)).with_tensions, grid.at(point)
        G, Ĝ = exact.response(BAND), other.response(BAND)
        error = np.linalg.norm(G - Ĝ, axis=(1, 2)) / np.linalg.norm(G, axis=(1, 2))
        out.append(
            InterpolationError(
                point=point,
                matrix=float(np.linalg.norm(exact.A - other.A) / np.linalg.norm(exact.A)),
                response=float(error.max()),
                eigenvalue=_eigenvalue_error(exact, other),
            )
        )
    return tuple(out)


def random_points(grid: GriddedSystem, points: int, seed: int) -> list[dict[str, float]]:
    """Returns random points within a grid."""
    rng = np.random.default_rng(seed)
    low, high = (np.array([axis[k] for axis in grid.axes.values()]) for k in (0, -1))
    rows = rng.uniform(low, high, (points, len(low)))
    return [dict(zip(grid.axes, map(float, row), strict=True)) for row in rows]


def run_error(
    robot: Twin,
    grid: GriddedSystem,
    point: dict[str, float],
    *,
    amplitude: float = 0.02,
    duration: float = 5.0,
    rate: float = 100.0,
    seed: int = 0,
) -> RunError:
    """Predict the twin under a small PRBS that begins at a point off the grid.

    Args:
        robot: the twin.
        grid: of `linearize_grid`, with the angles as outputs.
        point: values of the scheduling variables by name, in their units.
        amplitude: of the currents about those that hold the robot [A].
        duration: of the run [s].
        rate: of the samples [Hz].
        seed: of the PRBS.

    Raises:
        InputError: the point is outside the grid, or the robot cannot be held there.
        DivergenceError: the simulation left the finite numbers.
    """
    grid.place(point)
    h = sampling_time_of(rate)
    pose = _pose(robot, point)
    model, held = linearize(robot, pose, grid.outputs), held_at(robot, [pose])
    start = model.with_tensions
    N = round(duration / h) + 1
    u = start.u + prbs(N, h, seed=seed, low=-amplitude, high=amplitude)
    run = simulate(robot, u, h, start=State(held.qpos, held.qvel, held.act))
    moved = run.motor_angle - run.motor_angle[0]
    motion = float(np.sqrt(np.mean(moved**2)))
    _, fixed = start.discrete(rate).simulate(u)
    try:
        _, y = grid.simulate(start.x, u, rate)
        scheduled = float(np.sqrt(np.mean((y - run.motor_angle) ** 2))) / motion
    except InputError:
        scheduled = float("nan")
    return RunError(
        point=point,
        amplitude=amplitude,
        motion=motion,
        scheduled=scheduled,
        fixed=float(np.sqrt(np.mean((fixed - run.motor_angle) ** 2))) / motion,
        travel=float(np.linalg.norm(run.position - run.position[0], axis=1).max()),
    )


def _pose(robot: Twin, point: dict[str, float]) -> Sequence[float]:
    values = robot.parameters.values()
    return [point.get(name, values[name]) for name in POSE]


def _eigenvalue_error(own: LinearSystem, other: LinearSystem) -> float:
    """Returns the largest relative distance of an eigenvalue from the other system's nearest."""
    theirs = np.array([mode.eigenvalue for mode in modes(other)])
    return max(
        float(np.abs(theirs - mode.eigenvalue).min() / abs(mode.eigenvalue))
        for mode in modes(own)
        if mode.eigenvalue != 0
    )
