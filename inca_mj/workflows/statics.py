"""The statics of the robot at a pose: what holds it, how stiffly, where else it can be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from inca_mj.kinematics.cables import Cables, inverse
from inca_mj.kinematics.stiff import poses_with_stiff_cables
from inca_mj.robot.elastic import Robot
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import parameter_set
from inca_mj.statics.cable_mass import RHO, LineError, line_errors
from inca_mj.statics.closure import Closure, closure, require_closure
from inca_mj.statics.equilibrium import NONE, Equilibrium, equilibrium
from inca_mj.statics.interference import Interference, interference
from inca_mj.statics.robot import pull, static_robot
from inca_mj.statics.stiffness import (
    Axes,
    Modes,
    mass_matrix,
    modes,
    principal,
    stiffness,
    with_drums,
)
from inca_mj.statics.tensions import distribute, nearest
from inca_mj.statics.vibration import Coupled, coupled_modes
from inca_mj.statics.workspace import DriveLimits, Kind, Workspace, tension_limits, workspace
from inca_mj.twin.logs import pose_of


@dataclass(frozen=True, kw_only=True)
class Held:
    """The hold of the cables on the platform at a pose."""

    low: np.ndarray  # smallest tensions that the drives can give, shape (8,) [N]
    high: np.ndarray  # largest tensions, shape (8,) [N]
    nearest: np.ndarray  # tensions nearest to 4 N without limits, shape (8,) [N]
    minimum_norm: np.ndarray  # tensions of minimum norm without limits, shape (8,) [N]
    within: np.ndarray  # tensions nearest to 4 N within the limits, shape (8,) [N]
    current: np.ndarray  # of the motors that give `within`, shape (8,) [A]


@dataclass(frozen=True, kw_only=True)
class StaticAnalysis:
    """All that `analyse_statics` found.

    Attributes:
        robot: its numbers.
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        limits: what the drives may do, and what the platform shall bear.
        load: wrench on the platform beside its weight, shape (6,) [N, N m].
        closure: rank and closure of the wrench matrix.
        held: how the load is shared among the cables at the pose.
        rest: where the platform rests with the power off under the load.
        locked: stiffness at the pose with drums that do not turn, shape (6, 6) [N/m, N, N m/rad].
        free: stiffness with drums that turn against their springs, shape (6, 6) [N/m, N, N m/rad].
        push: principal stiffness against forces, drums locked.
        twist: principal stiffness against torques, drums locked.
        modes: of the platform, drums locked.
        modes_free: slowest modes of platform and drums together.
        nearness: of cables to each other and to the platform at the pose.
        nearness_along: the same over the workspace or the log; None without either.
        workspace: at the orientation of the pose; None where none was asked for.
        line_errors: what massless straight cables get wrong at the pose.
        cable_modes: modes of platform and swinging cables, one for each mass in `rho`.
        rho: masses of the cables per length [kg/m].
    """

    robot: Robot
    pose: np.ndarray
    limits: DriveLimits
    load: np.ndarray
    closure: Closure
    held: Held
    rest: Equilibrium
    locked: np.ndarray
    free: np.ndarray
    push: Axes
    twist: Axes
    modes: Modes
    modes_free: Modes
    nearness: Interference
    nearness_along: Interference | None
    workspace: Workspace | None
    line_errors: tuple[LineError, ...]
    cable_modes: tuple[Coupled, ...]
    rho: tuple[float, ...]


def analyse_statics(
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    pose: np.ndarray | None = None,
    *,
    load: np.ndarray = NONE,
    limits: DriveLimits | None = None,
    kind: Kind | None = None,
    cells: int = 24,
    log: Log | None = None,
    rho: Sequence[float] = RHO,
    seed: int = 0,
) -> StaticAnalysis:
    """Analyse the statics of the robot.

    Args:
        parameters: of the robot; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,); the start when None.
        load: wrench on the platform beside its weight, in O, shape (6,) [N, N m].
        limits: what the drives may do, and what the platform shall bear; the usual ones when None.
        kind: workspace at the orientation of the pose: "closure", "feasible" or "static".
        cells: of the workspace along the longest edge of the frame.
        log: along which cables may come near to each other.
        rho: masses of the cables per length [kg/m].
        seed: of the random points that measure the volume.

    Raises:
        InputError: the pose is outside the frame, the cables have no closure there, the load needs
            tensions outside the limits, the platform has no rest, a cable is slack, or an argument
            makes no sense.
    """
    robot = static_robot(parameters or parameter_set("trial"), geometry)
    limits, load = limits or DriveLimits(), np.asarray(load, float)
    pose = robot.start if pose is None else _reachable(pose, robot.geometry)
    if not rho or not (np.isfinite(rho).all() and min(rho) > 0):
        raise InputError(f"rho {list(rho)} kg/m: give masses per length above zero")
    at = inverse(pose, robot.geometry)
    spans = closure(at.W)
    require_closure(spans, pose)
    rest = equilibrium(robot, load=load)
    held = _held(robot, at, load, limits)
    locked = stiffness(at, held.within, (robot.lambda_ + held.within) / at.lengths)
    with_current = pull(robot, at.lengths, held.current)
    free = stiffness(at, with_current.tension, with_current.stiffness)
    push, twist = principal(locked)
    M = mass_matrix(robot, pose)
    found = None
    if kind is not None:
        found = workspace(kind, robot, pose[3:], limits=limits, cells=cells, seed=seed)
    along = found.poses if found is not None and found.inside.any() else None
    if log is not None:
        along = pose_of(log)
        if along is None:
            along = poses_with_stiff_cables(log.outputs, robot.R, robot.start, robot.geometry)
    return StaticAnalysis(
        robot=robot,
        pose=pose,
        limits=limits,
        load=load,
        closure=spans,
        held=held,
        rest=rest,
        locked=locked,
        free=free,
        push=push,
        twist=twist,
        modes=modes(locked, M),
        modes_free=modes(
            with_drums(robot, at, held.within, with_current.no_load),
            block_diag(M, np.diag(robot.J)),
        ),
        nearness=interference(pose, robot.geometry),
        nearness_along=None if along is None else interference(along, robot.geometry),
        workspace=found,
        line_errors=line_errors(robot, pose, rho),
        cable_modes=tuple(coupled_modes(robot, pose, at, held.within, mass) for mass in rho),
        rho=tuple(rho),
    )


def _held(robot: Robot, at: Cables, load: np.ndarray, limits: DriveLimits) -> Held:
    low, high = tension_limits(robot, at.lengths, limits)
    weak = int(np.argmin(high))
    if limits.taut > high[weak]:
        raise InputError(
            f"every cable shall keep {limits.taut:g} N, but with the largest current of"
            f" {limits.current[1]:g} A cable {weak + 1} has only {high[weak]:.3g} N at this pose;"
            " give a smaller tension (--taut) or a larger current (--current)"
        )
    w = robot.weight - load
    T = distribute(at.W, w, low, high)
    springs = pull(robot, at.lengths).tension  # a current adds K_t i/R, and the drum does not turn
    return Held(
        low=low, high=high, nearest=nearest(at.W, w), minimum_norm=nearest(at.W, w, 0.0), within=T,
        current=_current(robot, at.lengths, T, springs),
    )  # fmt: skip


def _current(robot: Robot, d: np.ndarray, T: np.ndarray, springs: np.ndarray) -> np.ndarray:
    """Returns the currents with which the drums balance tensions T, shape (8,) [A]."""
    current = robot.R * (T - springs) / robot.K_t
    for _ in range(4):  # the spring's tension feels the current by the strain of the cable only
        wrong = T - pull(robot, d, current).tension
        current = current + robot.R * wrong / robot.K_t
    return current


def _reachable(pose: np.ndarray, geometry: Geometry) -> np.ndarray:
    """Returns the pose, or refuses what is no pose inside the frame."""
    pose = np.asarray(pose, float)
    if pose.shape != (6,) or not np.isfinite(pose).all():
        raise InputError(
            f"a pose is six finite numbers x, y, z [m], roll, pitch, yaw [rad], not {pose.tolist()}"
        )
    low, high = geometry.A.min(axis=0), geometry.A.max(axis=0)
    for axis, x, a, b in zip("xyz", pose, low, high, strict=False):
        if not a < x < b:
            raise InputError(
                f"pose {np.round(pose, 4).tolist()} cannot be reached: {axis} = {x:g} m lies"
                f" outside the frame, whose exit points span {a:g} to {b:g} m"
            )
    return pose
