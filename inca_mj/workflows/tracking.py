"""Let a robot follow a path under a controller, and say how well: `track`.

e_k = p(t_k) - p_d(t_k)              of the true platform, counted from the path's full rate on
c_k = e_k - (e_k · t_k) t_k          cross-track error: what is not along the path's tangent t_k

The platform may follow the path well and late: e is then large and c is small.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError
from inca_mj.control.controller import CONTROL_TIMESTEP, Controller, Gains, run_loop
from inca_mj.control.inverse import Tensions
from inca_mj.control.paths import Circle, Path
from inca_mj.robot.parameters import POSE
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin, build_twin

APART = 0.05  # [m] from the robot's start, at which a path is one of another place


@dataclass(frozen=True, kw_only=True)
class Tracking:
    """A robot that followed a path.

    Attributes:
        run: what the robot did, N samples, and the positions that were asked of it.
        model: the twin that the controller believed.
        path: where the platform should have been.
        seen: positions as the controller saw them, shape (N, 3) [m].
        counted: from when on errors count [s].
    """

    run: Run
    model: Twin
    path: Path
    seen: np.ndarray
    counted: float

    @property
    def asked(self) -> np.ndarray:
        """Positions asked of the platform, shape (N, 3) [m]."""
        return np.asarray(self.run.asked)

    @property
    def error(self) -> np.ndarray:
        """True position less that asked, shape (N, 3) [m]."""
        return self.run.position - self.asked

    @property
    def rms(self) -> float:
        """Root mean square of the distance from the asked point, of the samples that count [m]."""
        return float(np.sqrt(np.mean(self._counted(self.error) ** 2)))

    @property
    def largest(self) -> float:
        """Largest distance from the asked point, of the samples that count [m]."""
        return float(self._counted(self.error).max())

    @property
    def cross_track_rms(self) -> float:
        """Root mean square of the cross-track error, of the samples that count [m]."""
        along = np.gradient(self.asked, self.run.time, axis=0)
        length = np.linalg.norm(along, axis=1, keepdims=True)
        tangent = np.divide(along, length, out=np.zeros_like(along), where=length > 0)
        lag = np.sum(self.error * tangent, axis=1, keepdims=True) * tangent
        return float(np.sqrt(np.mean(self._counted(self.error - lag) ** 2)))

    @property
    def seen_rms(self) -> float:
        """Root mean square of what the controller sees of the error [m]."""
        return float(np.sqrt(np.mean(self._counted(self.seen - self.asked) ** 2)))

    @property
    def turned(self) -> float:
        """Largest angle of the platform from upright, of the samples that count [rad]."""
        w = np.abs(self.run.qpos[self.run.time >= self.counted, 3])
        return float(2 * np.arccos(np.clip(w, 0, 1)).max())

    def _counted(self, difference: np.ndarray) -> np.ndarray:
        return np.asarray(np.linalg.norm(difference[self.run.time >= self.counted], axis=1))


def track(
    robot: Twin | None = None,
    model: Twin | None = None,
    path: Path | None = None,
    *,
    duration: float = 10.0,
    gains: Gains | None = None,
    tensions: Tensions | None = None,
    knows_pose: bool = False,
    noise: float = 0.0,
    seed: int = 0,
) -> Tracking:
    """Follow a path with a robot, by a controller that sees motor angles and believes a model.

    Args:
        robot: the robot with all that it truly has; the nominal twin when None.
        model: the twin that the controller believes; the nominal twin when None. It starts at the
            pose of the robot, which a robot knows from its homing.
        path: a circle of 0.3 m radius about the start at 1 rad/s when None.
        duration: of the run [s].
        gains: of the feedback.
        tensions: to stay near to, and their limits.
        knows_pose: whether the controller is told the true pose instead of estimating it.
        noise: std of the encoders' noise [rad].
        seed: of the noise.

    Raises:
        InputError: the path begins elsewhere than the robot or leaves the room between the exit
            points, the run ends before its errors count, a number makes no sense, or the
            controller loses the pose.
        DivergenceError: the robot left the finite numbers.
    """
    robot = robot or build_twin()
    values = robot.parameters.values()
    model = (model or build_twin()).with_values({name: values[name] for name in POSE})
    path = path or Circle(centre=(values["x"], values["y"], values["z"]))
    begin = path.at(0.0).position
    if np.linalg.norm(begin - robot.start.pose[:3]) > APART:
        raise InputError(
            f"the path begins at {np.round(begin, 3).tolist()} m, but the robot at"
            f" {np.round(robot.start.pose[:3], 3).tolist()} m; move one to the other"
        )
    if not np.isfinite(duration):
        raise InputError(f"a run of {duration:g} s; give a duration in seconds")
    counted = path.full if isinstance(path, Circle) else 0.0
    if not counted < duration:
        raise InputError(
            f"a run of {duration:g} s ends before the path is at its full rate, after {counted:g}"
            " s; give a longer duration"
        )
    _refuse_outside(path, robot, duration)
    controller = Controller(model, path, gains=gains, tensions=tensions)
    done = run_loop(robot, controller, duration, knows_pose=knows_pose, noise=noise, seed=seed)
    run = simulate(robot, done.currents, CONTROL_TIMESTEP)
    asked = np.array([path.at(float(t)).position for t in run.time])
    return Tracking(
        run=replace(run, asked=asked), model=model, path=path, seen=done.seen, counted=counted
    )


def _refuse_outside(path: Path, robot: Twin, duration: float) -> None:
    """Refuse a path that no platform between the exit points can follow."""
    times = np.arange(0.0, duration + CONTROL_TIMESTEP, CONTROL_TIMESTEP)
    asked = np.array([path.at(float(t)).position for t in times])
    exits = robot.geometry.A
    low, high = exits.min(axis=0), exits.max(axis=0)
    beyond = ((asked < low) | (asked > high)).any(axis=1)
    if beyond.any():
        at = np.round(asked[int(np.argmax(beyond))], 3).tolist()
        raise InputError(
            f"the path leaves the room between the exit points, at {at} m; the room is from"
            f" {low.tolist()} to {high.tolist()} m: give a smaller path, or another start"
        )
