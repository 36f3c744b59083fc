"""The places where the platform can be at one orientation: three workspaces, as margins.

    closure    every wrench can be exerted, if tensions may be as large as they like
    feasible   a set of wrenches can be exerted within the tension limits
    static     the weight alone can be carried within the tension limits

The tension limits follow from the motors' currents and the drum springs, which pull more where a
cable is long: low and high are the tensions at the smallest and the largest current with the drums
in balance (`robot.pull`), and low is at least a tension that keeps a cable taut.

The margin is positive inside and negative outside (`closure.gap_margin`, `closure.wrench_margin`).
Points lie in the box of the exit points; a platform that is small beside the frame cannot be held
outside of it.

The volume is estimated by stratified sampling: two random points in each of the M cells of volume
c, a and b saying whether they are inside,

    V = c Σ (a + b)/2,   Var V = c² Σ (a − b)²/4

which is without bias, and whose standard error only the cells at the border make (Cochran 1977,
Sampling Techniques, chapter 5).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from identification.errors import InputError, unknown_name
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.elastic import Robot
from inca_mj.statics.closure import gap_margin, split, wrench_margin
from inca_mj.statics.robot import pull

Kind = Literal["closure", "feasible", "static"]
NAMES: dict[Kind, str] = {
    "closure": "wrench-closure",
    "feasible": "wrench-feasible",
    "static": "static",
}
MOST = 200  # cells along an edge: beyond, memory ends before patience


@dataclass(frozen=True, kw_only=True)
class DriveLimits:
    """Limits of the drives, and the loads that the platform shall bear.

    Attributes:
        current: smallest and largest current of a motor [A].
        taut: every cable keeps at least this tension [N].
        force: largest force on the platform, in any direction [N]; of the feasible workspace.
        torque: largest torque on the platform, about any axis [N m]; of the feasible workspace.

    Raises:
        InputError: a number is not finite or negative, or the smallest current is the larger one.
    """

    current: tuple[float, float] = (-2.0, 2.0)
    taut: float = 0.5
    force: float = 1.0
    torque: float = 0.02

    def __post_init__(self) -> None:
        low, high = self.current
        if not (np.isfinite([low, high]).all() and low < high):
            raise InputError(
                f"currents from {low:g} to {high:g} A are no range; give the smaller one first"
            )
        for name, unit in (("taut", "N"), ("force", "N"), ("torque", "N m")):
            if not 0 <= getattr(self, name) < np.inf:
                raise InputError(
                    f"{name} {getattr(self, name):g} {unit} is not possible; give zero or more"
                )


def tension_limits(
    robot: Robot, d: np.ndarray, limits: DriveLimits
) -> tuple[np.ndarray, np.ndarray]:
    """Returns smallest and largest tensions at rest [N] at cable lengths [m], all (..., 8)."""
    low, high = (pull(robot, d, current).tension for current in limits.current)
    return np.maximum(low, limits.taut), high


def margin(kind: Kind, robot: Robot, poses: np.ndarray, limits: DriveLimits) -> np.ndarray:
    """Returns how far poses (N, 6) are inside a workspace, (N,): [rad] for closure, else [N]."""
    if kind not in NAMES:
        raise unknown_name("workspace", kind, NAMES)
    at = inverse(poses, robot.geometry)
    plus, N, full = split(at.W)
    if kind == "closure":
        return gap_margin(N, full)
    low, high = tension_limits(robot, at.lengths, limits)
    more = (limits.force, limits.torque) if kind == "feasible" else ()
    return wrench_margin(plus, N, full, low, high, robot.weight, *more)


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """A workspace at one orientation."""

    kind: Kind  # "closure", "feasible" or "static"
    orientation: np.ndarray  # roll, pitch, yaw, shape (3,) [rad]
    axes: tuple[np.ndarray, np.ndarray, np.ndarray]  # coordinates of the grid along x, y and z [m]
    margin: np.ndarray  # at the points of the grid, shape (X, Y, Z): [rad] for closure, else [N]
    volume: float  # [m^3]
    std: float  # standard error of the volume [m^3]

    @property
    def inside(self) -> np.ndarray:
        """True where a point of the grid is inside, shape (X, Y, Z) of bool."""
        return self.margin > 0

    @property
    def poses(self) -> np.ndarray:
        """The poses of the grid inside, shape (n, 6) [m, rad]."""
        points = np.stack(np.meshgrid(*self.axes, indexing="ij"), -1)[self.inside]
        return _poses(points, self.orientation)


def workspace(
    kind: Kind,
    robot: Robot,
    orientation: np.ndarray | tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    limits: DriveLimits | None = None,
    cells: int = 24,
    seed: int = 0,
) -> Workspace:
    """Returns the workspace at a constant orientation.

    Args:
        kind: "closure", "feasible" or "static".
        robot: its numbers.
        orientation: roll, pitch, yaw, shape (3,) [rad].
        limits: of the drives, and what the platform shall bear; the usual ones when None.
        cells: along the longest edge of the box of the exit points.
        seed: of the random points that measure the volume.

    Raises:
        InputError: the kind is unknown, the orientation is not three finite numbers, or there are
            too few or too many cells.
    """
    limits, turned = limits or DriveLimits(), np.asarray(orientation, float)
    if turned.shape != (3,) or not np.isfinite(turned).all():
        raise InputError(
            f"an orientation is three finite numbers roll, pitch, yaw [rad], not {orientation}"
        )
    if not 4 <= cells <= MOST:
        raise InputError(f"{cells} cells along an edge; give 4 to {MOST}")
    low, high = robot.geometry.A.min(axis=0), robot.geometry.A.max(axis=0)
    count = np.maximum(2, np.round(cells * (high - low) / (high - low).max()).astype(int))
    size = (high - low) / count
    axes = [a + (np.arange(n) + 0.5) * h for a, n, h in zip(low, count, size, strict=True)]
    centres = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    rng = np.random.default_rng(seed)
    two = [
        margin(kind, robot, _poses(centres + size * rng.uniform(-0.5, 0.5, centres.shape), turned),
               limits) > 0
        for _ in range(2)
    ]  # fmt: skip
    cell = float(np.prod(size))
    return Workspace(
        kind=kind,
        orientation=turned,
        axes=(axes[0], axes[1], axes[2]),
        margin=margin(kind, robot, _poses(centres, turned), limits).reshape(count),
        volume=cell * float(two[0].sum() + two[1].sum()) / 2,
        std=cell * float(np.sqrt((two[0] != two[1]).sum()) / 2),
    )


def _poses(points: np.ndarray, orientation: np.ndarray) -> np.ndarray:
    return np.hstack([points, np.broadcast_to(orientation, points.shape)])
