"""Tasks for the robot: hold the platform, reach a target, track a circle.

    reward = near(|p - p_d|) level(angle from upright)        1 near the target, falling to 0.1

What is observed is what the real robot tells: motor angles by its encoders, their last difference
over the time between, the pose at which the angles are zero (from its homing), and what is asked of
the platform. Pose and tensions are observed only if that is asked for: `privileged`.
"""

from __future__ import annotations

import warnings
from collections import OrderedDict
from collections.abc import Mapping
from typing import Any

import numpy as np
from dm_control.rl import control
from dm_control.utils import rewards
from dm_env import specs

from inca_mj.control.inverse import HIGHEST_CURRENT, LOWEST_CURRENT
from inca_mj.control.paths import Circle, Motion, Path, Point
from inca_mj.robot import law
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.parameters import POSE
from inca_mj.twin.mjcf import build
from inca_mj.twin.statics import Start, start, start_state
from inca_mj.twin.twin import Twin

with warnings.catch_warnings():
    # dm_control tries GLFW while it is imported, which prints warnings without a display.
    warnings.filterwarnings("ignore", ".*DISPLAY")
    from dm_control import mujoco as dm_mujoco

TARGET = "target"
START_SPREAD = np.array([0.02] * 3 + [0.05] * 3)  # half-width of the start poses [m, rad]
HAND = (0.5, 2.0)  # least and largest force of the hand [N]; 2 A could hold 8 N
REACH = np.array([0.2, 0.2, 0.2])  # half-width of the box of targets [m]; all of them can be held
# The reward is 1 within these limits, and falls to 0.1 at the margin beyond them.
NEAR, NEAR_MARGIN = 0.005, 0.1  # distance of the platform from its target [m]
LEVEL, LEVEL_MARGIN = 0.02, 0.3  # angle of the platform from upright [rad]


class Handle(control.Task):
    """The common part of all tasks: the start, the currents, the observations and the reward.

    Args:
        robot: the twin that is driven.
        random: seed, or a generator to draw from.
        privileged: whether position, orientation and tensions are observed too.
        encoder_noise: std of the noise of the motor angles [rad].
    """

    spread = START_SPREAD

    def __init__(
        self,
        robot: Twin,
        random: int | np.random.Generator | None = None,
        *,
        privileged: bool = False,
        encoder_noise: float = 0.0,
    ) -> None:
        self.robot, self.random = robot, np.random.default_rng(random)
        self.privileged, self.encoder_noise = privileged, encoder_noise
        self.begin = robot.start
        self.path: Path = Point(tuple(robot.start.pose[:3]))
        self._angle, self._rate, self._time = np.zeros(DRIVES), np.zeros(DRIVES), 0.0

    def initialize_episode(self, physics: Physics) -> None:
        """Put the robot at rest near its nominal start, with the pretension for its pose."""
        nominal = self.robot.parameters
        shift = self.random.uniform(-self.spread, self.spread)
        values = {n: nominal[n].value + s for n, s in zip(POSE, shift, strict=True)}
        self.begin = start(nominal.with_values(values), self.robot.geometry, self.robot.layout)
        physics.begin(self.begin)
        self.path = self.draw_path(self.begin.pose[:3])
        self._mark(physics)
        self._angle, self._rate, self._time = self._read(np.zeros(DRIVES)), np.zeros(DRIVES), 0.0

    def draw_path(self, begin: np.ndarray) -> Path:
        """Returns the wanted path in an episode that starts at `begin`, shape (3,) [m]."""
        raise NotImplementedError

    def action_spec(self, physics: Physics) -> specs.BoundedArray:
        """Returns the specification of the action: eight currents [A]."""
        return specs.BoundedArray(
            (DRIVES,), float, LOWEST_CURRENT, HIGHEST_CURRENT, name="currents [A]"
        )

    def before_step(self, action: Any, physics: Physics) -> None:
        """Gives the motors their currents, within the range of the amplifiers.

        Raises PhysicsError if a current is not a finite number; the state is left as it was.
        """
        currents = np.asarray(action, float)
        if not np.isfinite(currents).all():
            raise control.PhysicsError(f"the currents must be finite numbers [A], got {currents}")
        physics.set_control(np.clip(currents, LOWEST_CURRENT, HIGHEST_CURRENT))

    def after_step(self, physics: Physics) -> None:
        """Read the encoders, and move the mark of the target."""
        angle, time = self._read(physics.motor_angle()), physics.data.time
        self._rate = (angle - self._angle) / (time - self._time)
        self._angle, self._time = angle, time
        self._mark(physics)

    def asked(self, physics: Physics) -> Motion:
        """Returns the motion that is asked of the platform now."""
        return self.path.at(physics.data.time)

    def get_observation(self, physics: Physics) -> Mapping[str, np.ndarray]:
        """Returns what the robot measures, and where the platform should be."""
        asked = self.asked(physics)
        seen = OrderedDict(
            motor_angle=self._angle.copy(),
            motor_rate=self._rate.copy(),
            start=self.begin.pose.copy(),
            target=asked.position,
            target_velocity=asked.velocity,
            target_acceleration=asked.acceleration,
        )
        if self.privileged:
            seen["position"] = physics.handle_position()
            seen["orientation"] = physics.handle_orientation()
            seen["tension"] = physics.tension()
        return seen

    def get_reward(self, physics: Physics) -> float:
        """Returns the reward between 0 and 1: it is 1 near the target and upright."""
        distance = np.linalg.norm(physics.handle_position() - self.asked(physics).position)
        angle = 2 * np.arccos(np.clip(abs(physics.handle_orientation()[0]), 0, 1))
        near = rewards.tolerance(distance, (0, NEAR), NEAR_MARGIN)
        level = rewards.tolerance(angle, (0, LEVEL), LEVEL_MARGIN)
        return float(near * level)

    def _read(self, angle: np.ndarray) -> np.ndarray:
        if self.encoder_noise:
            return angle + self.random.normal(0.0, self.encoder_noise, DRIVES)
        return angle

    def _mark(self, physics: Physics) -> None:
        physics.named.model.site_pos[TARGET] = self.asked(physics).position


class Hold(Handle):
    """Keep the platform where it starts, against the constant, unobserved force of a hand."""

    def initialize_episode(self, physics: Physics) -> None:
        """Start an episode, and let the hand pull in a random direction."""
        super().initialize_episode(physics)
        direction = self.random.normal(size=3)
        force = self.random.uniform(*HAND) * direction / np.linalg.norm(direction)
        physics.named.data.xfrc_applied["platform", :3] = force

    def draw_path(self, begin: np.ndarray) -> Path:
        """Returns the start itself as the target."""
        return Point(tuple(begin))


class Reach(Handle):
    """Bring the platform to a target that it can hold."""

    def draw_path(self, begin: np.ndarray) -> Path:
        """Returns a random target in a box about the nominal start."""
        nominal = self.robot.parameters
        centre = np.array([nominal[n].value for n in "xyz"])
        return Point(tuple(centre + self.random.uniform(-REACH, REACH)))


class Track(Handle):
    """Follow a level circle of 0.3 m radius at 1 rad/s, from rest in its centre."""

    spread = np.zeros(6)

    def draw_path(self, begin: np.ndarray) -> Path:
        """Returns the circle about the start; its way out has a random direction."""
        return Circle(centre=tuple(begin), phase=float(self.random.uniform(0, 2 * np.pi)))


TASKS: Mapping[str, type[Handle]] = {"hold": Hold, "reach": Reach, "track": Track}


class Physics(dm_mujoco.Physics):
    """The twin under dm_control; `reset` puts it to its pretensioned rest.

    Attributes:
        rest: the start of the twin, None for a model that was loaded without one.
    """

    rest: Start | None = None

    def reset(self, keyframe_id: int | None = None) -> None:
        """Puts the robot to rest at its start, where it can be stepped, or to a keyframe."""
        if self.rest is not None:
            self.model.actuator_user[:, law.T_0] = self.rest.balance
        super().reset(int(self.model.key("start").id) if keyframe_id is None else keyframe_id)

    def copy(self, share_model: bool = False) -> Physics:
        """Returns a copy with the same state and rest, and the same model if it is shared."""
        other = super().copy(share_model)
        other.rest = self.rest
        return other

    def begin(self, at: Start) -> None:
        """Put the robot to rest at another start; its drum springs balance that one."""
        state = start_state(at)
        self.model.actuator_user[:, law.T_0] = at.balance
        self.data.qpos[:], self.data.qvel[:] = state.qpos, state.qvel
        self.data.act[:] = state.act

    def motor_angle(self) -> np.ndarray:
        """Returns the motor angles φ, shape (8,) [rad]."""
        return self._drives("angle")

    def tension(self) -> np.ndarray:
        """Returns the cable tensions T, shape (8,) [N]."""
        return self._drives("tension")

    def handle_position(self) -> np.ndarray:
        """Returns the position of the platform in O, shape (3,) [m]."""
        return self.named.data.sensordata["position"].copy()

    def handle_orientation(self) -> np.ndarray:
        """Returns the orientation of the platform, unit quaternion w, x, y, z, shape (4,)."""
        return self.named.data.sensordata["orientation"].copy()

    def _drives(self, sensor: str) -> np.ndarray:
        first = self.model.sensor(f"{sensor}_1").adr[0]
        return self.data.sensordata[first : first + DRIVES].copy()


def physics_of(robot: Twin) -> Physics:
    """Returns a robot as Physics, with a site that marks the target."""
    spec = build(robot.parameters, robot.geometry, robot.layout)
    spec.option.timestep = robot.model.opt.timestep
    spec.worldbody.add_site(name=TARGET, size=[0.01, 0.01, 0.01], rgba=[0.1, 0.7, 0.2, 0.6])
    physics = Physics.from_model(dm_mujoco.wrapper.MjModel(spec.compile()))
    physics.rest = robot.start
    physics.reset()
    return physics
