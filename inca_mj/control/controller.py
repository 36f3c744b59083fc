"""Computed wrench: the platform follows a path, from motor angles to currents at 100 Hz.

    e = (p_d - p, ½ Σ r_j × r_dj)                    error of the pose; r_j the body's axes
    a = a_d + K_p e + K_d ė + K_i ∫e dt              acceleration that is asked [m/s², rad/s²]
    i = inverse of the twin (a, motion asked, φ measured)

In a robot that is exactly the twin and whose cables are stiff, the error obeys
ë + K_d ė + (K_p + K_T) e + K_i ∫e = 0, whatever the twin's friction. K_T = Σ T (1 - s sᵀ)/d over
the inertia is what taut cables do by themselves to a platform beside its path. The terms of the
twin are taken at the motion that is asked, and not at the measured one: steep friction at a
measured rate, compensated 10 ms late, would make the loop unstable. ė is the last
step's difference.

(The computed torque of Luh, Walker, Paul 1980, on the platform's six coordinates; for cable robots
see Pott 2018, Cable-Driven Parallel Robots.)
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import DivergenceError, InputError
from identification.model.rollout import substeps
from inca_mj.control.inverse import HIGHEST_CURRENT, LOWEST_CURRENT, Inverse, Tensions
from inca_mj.control.observer import Observer, Pose
from inca_mj.control.paths import Path
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.logs import ANGLES
from inca_mj.twin.twin import Twin

CONTROL_TIMESTEP = 0.01  # [s], the sampling time of the robot's own controller
NOTHING = np.empty((1, 0))


@dataclass(frozen=True, kw_only=True)
class Gains:
    """Gains of the correction of errors: two poles at -bandwidth.

    Attributes:
        bandwidth: ω_c, so that K_p = ω_c² and K_d = 2 ω_c [rad/s].
        integral: K_i/ω_c³; 0.5 removes what a constant force leaves in about a third of a second.

    Raises:
        InputError: a gain is negative, or no number.
    """

    bandwidth: float = 25.0
    integral: float = 0.0

    def __post_init__(self) -> None:
        for name in ("bandwidth", "integral"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise InputError(f"a {name} of {value:g}; give a number that is not negative")


class Controller:
    """Follows a path with a robot that it believes to be a twin.

    Args:
        robot: the twin that is its model; its start is the robot's.
        path: where the platform should be.
        gains: of the feedback.
        tensions: to stay near to, and their limits.
        period: time between two calls of `currents` [s].

    Raises:
        InputError: the bandwidth is beyond 1/period: such a feedback acts on what is long past.
    """

    def __init__(
        self,
        robot: Twin,
        path: Path,
        *,
        gains: Gains | None = None,
        tensions: Tensions | None = None,
        period: float = CONTROL_TIMESTEP,
    ) -> None:
        self.path, self.gains, self.period = path, gains or Gains(), period
        if self.gains.bandwidth * period > 1:
            raise InputError(
                f"a bandwidth of {self.gains.bandwidth:g} rad/s is beyond {1 / period:g} rad/s, one"
                f" over the controller's period of {period:g} s; give less"
            )
        self._inverse, self._observer = Inverse(robot, tensions), Observer(robot)
        self._error: np.ndarray | None = None
        self._sum, self._step = np.zeros(6), 0
        pose, quaternion = robot.start.pose, np.array(robot.model.qpos0[3:7])
        self.pose = Pose(pose[:3], quaternion)  # as last seen

    def currents(self, angle: np.ndarray, pose: Pose | None = None) -> np.ndarray:
        """Returns the currents until the next call, within the limits of the amplifiers.

        Args:
            angle: φ as measured now, shape (8,) [rad].
            pose: of the platform, where it is known otherwise; from the angles when None.

        Returns:
            Shape (8,) [A].

        Raises:
            InputError: no pose of the platform belongs to the angles.
        """
        time = self._step * self.period
        motion, middle = self.path.at(time), self.path.at(time + self.period / 2)
        asked = np.concatenate([motion.acceleration, np.zeros(3)])
        self.pose = pose or self._observer.seen(angle, asked, time)
        error = np.concatenate(
            [motion.position - self.pose.position, _turn_to_upright(self.pose.orientation)]
        )
        rate = (error - (error if self._error is None else self._error)) / self.period
        self._sum, self._error, self._step = self._sum + error * self.period, error, self._step + 1
        ω, ι = self.gains.bandwidth, self.gains.integral
        more = ω**2 * error + 2 * ω * rate + ι * ω**3 * self._sum
        needed = self._inverse.needed(middle, more, angle, time)
        return np.clip(needed.currents, LOWEST_CURRENT, HIGHEST_CURRENT)


def _turn_to_upright(orientation: np.ndarray) -> np.ndarray:
    """Returns ½ Σ r_j × r_dj for axes r_j of the body and those of the frame, shape (3,) [rad]."""
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, orientation)
    return np.cross(R.reshape(3, 3).T, np.eye(3)).sum(axis=0) / 2


@dataclass(frozen=True)
class Controlled:
    """The record of a controller, N samples; `simulate(robot, currents)` is the run."""

    currents: np.ndarray  # shape (N, 8) [A]; sample k is held until k+1
    seen: np.ndarray  # position of the platform as the controller saw it, shape (N, 3) [m]


def run_loop(
    robot: Twin, controller: Controller, duration: float, *, knows_pose: bool = False,
    noise: float = 0.0, seed: int = 0,
) -> Controlled:  # fmt: skip
    """Drives a robot by a controller, from the robot's start on, for a duration [s].

    The robot has the effects that it truly has. The controller sees its encoders, with white noise
    of a std [rad], and the true pose if it `knows_pose`. Raises InputError if the model's step does
    not divide the controller's period, the noise is negative or no number, or the controller finds
    no pose; DivergenceError if the robot leaves the finite numbers.
    """
    if not (np.isfinite(noise) and noise >= 0):
        raise InputError(f"a noise of {noise:g} rad; give 0 or more")
    model, data = robot.model, mujoco.MjData(robot.model)
    begin, rng = robot.state(), np.random.default_rng(seed)
    data.qpos[:], data.qvel[:], data.act[:] = begin.qpos, begin.qvel, begin.act
    n, count = substeps(controller.period, model.opt.timestep), round(duration / controller.period)
    held, currents = np.empty((count * n, DRIVES)), np.empty((count + 1, DRIVES))
    seen = np.empty((count + 1, 3))
    readings = np.empty((4, 1, count + 1, DRIVES))  # φ as perfect encoders tell it, φ, ω, time
    for k in range(count + 1):
        readings[:2, 0, k], readings[2, 0, k] = data.qpos[7:], data.qvel[6:]
        readings[3, 0, k] = k * controller.period
        told = robot.outputs((), NOTHING, ANGLES, readings[:, :, : k + 1])[0, -1]
        told = told + noise * rng.standard_normal(DRIVES)
        pose = Pose(data.qpos[:3].copy(), data.qpos[3:7].copy()) if knows_pose else None
        currents[k] = controller.currents(told, pose)
        seen[k] = controller.pose.position
        if k == count:
            break
        held[k * n : (k + 1) * n] = currents[k]
        given = robot.inputs((), NOTHING, held[: (k + 1) * n], model.opt.timestep)
        for row in given.reshape(-1, DRIVES)[-n:]:
            data.ctrl[:] = row
            mujoco.mj_step(model, data)
        if not np.isfinite(data.qpos).all():
            raise DivergenceError(
                f"the controlled robot diverges at {(k + 1) * controller.period:.2f} s; lower the"
                " bandwidth of the controller"
            )
    return Controlled(currents, seen)
