"""The robot as a dm_control environment: eight currents in, angles, pose and tensions out.

    env = inca_mj.load_environment("hold", random=0)

There are two tasks. `hold`: keep the handle where it starts, while a hand pulls at it with a
constant force that is not observed. `reach`: bring the handle to a target. The module needs
dm_control: pip install inca-mj[control]. To draw without a display, set MUJOCO_GL=egl before MuJoCo
is imported.
"""

from __future__ import annotations

import warnings
from collections import OrderedDict
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from identification.errors import unknown_name
from inca_mj.files import model_path
from inca_mj.robot import law
from inca_mj.robot.geometry import DRIVES, INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin import native
from inca_mj.twin.statics import start
from inca_mj.twin.twin import start_state

with warnings.catch_warnings():
    # dm_control tries GLFW while it is imported, which prints warnings without a display.
    warnings.filterwarnings("ignore", ".*DISPLAY")
    from dm_control import mujoco as dm_mujoco
    from dm_control.rl import control
    from dm_control.utils import rewards
    from dm_env import specs

CONTROL_TIMESTEP = 0.01  # [s], the sampling time of the robot's own controller
TIME_LIMIT = 10.0  # of an episode [s]

# The drum springs hold the handle without current. A positive current winds the cable in, so that
# no current below zero is needed, and no current slackens a cable at rest. 2 A is the largest
# current of the thesis (Figure 2.16); it is assumed that the motors can bear it continuously.
LOWEST_CURRENT, HIGHEST_CURRENT = 0.0, 2.0  # [A]

START_SPREAD = np.array([0.02] * 3 + [0.05] * 3)  # half-width of the start poses [m, rad]
HAND = (0.5, 2.0)  # least and largest force of the hand [N]; 2 A could hold 8 N
REACH = np.array([0.2, 0.2, 0.2])  # half-width of the box of targets [m]; all of them can be held

# The reward is 1 within these limits, and falls to 0.1 at the margin beyond them.
NEAR, NEAR_MARGIN = 0.005, 0.1  # distance of the handle from its target [m]
LEVEL, LEVEL_MARGIN = 0.02, 0.3  # angle of the handle from upright [rad]

TARGET = "target"


class Physics(dm_mujoco.Physics):
    """The twin, with names for what the robot measures and its user sees."""

    def motor_angle(self) -> np.ndarray:
        """Motor angles φ, shape (8,) [rad]."""
        return self._drives("angle")

    def motor_rate(self) -> np.ndarray:
        """Motor rates ω, shape (8,) [rad/s]."""
        return self._drives("rate")

    def tension(self) -> np.ndarray:
        """Cable tensions T, shape (8,) [N]."""
        return self._drives("tension")

    def handle_position(self) -> np.ndarray:
        """Position of the handle in O, shape (3,) [m]."""
        return self.named.data.sensordata["position"].copy()

    def handle_orientation(self) -> np.ndarray:
        """Orientation of the handle, unit quaternion w, x, y, z, shape (4,)."""
        return self.named.data.sensordata["orientation"].copy()

    def target(self) -> np.ndarray:
        """Where the handle should be, in O, shape (3,) [m]."""
        return self.named.model.site_pos[TARGET].copy()

    def _drives(self, sensor: str) -> np.ndarray:
        first = self.model.sensor(f"{sensor}_1").adr[0]
        return self.data.sensordata[first : first + DRIVES].copy()


class Handle(control.Task):
    """What both tasks share: the start, the currents, the observations and the reward.

    Args:
        random: seed, or a generator to draw from.
    """

    def __init__(self, random: int | np.random.Generator | None = None) -> None:
        self.random = np.random.default_rng(random)

    def initialize_episode(self, physics: Physics) -> None:
        """Put the robot at rest near its nominal start, with the pretension for its pose."""
        nominal = parameter_set()
        names = ("x", "y", "z", "roll", "pitch", "yaw")
        shift = self.random.uniform(-START_SPREAD, START_SPREAD)
        values = {n: nominal[n].value + s for n, s in zip(names, shift, strict=True)}
        begin = start(nominal.with_values(values), INCA)
        state = start_state(begin)
        physics.model.actuator_user[:, law.T_0] = begin.tension  # the drum springs balance it
        physics.data.qpos[:], physics.data.qvel[:] = state.qpos, state.qvel
        physics.data.act[:] = state.act
        physics.named.model.site_pos[TARGET] = self.draw_target(begin.pose[:3])

    def draw_target(self, begin: np.ndarray) -> np.ndarray:
        """The target of an episode that starts at `begin`, shape (3,) [m]."""
        raise NotImplementedError

    def action_spec(self, physics: Physics) -> specs.BoundedArray:
        """Eight currents [A]."""
        return specs.BoundedArray(
            (DRIVES,), float, LOWEST_CURRENT, HIGHEST_CURRENT, name="currents [A]"
        )

    def before_step(self, action: Any, physics: Physics) -> None:
        """Give the motors their currents; the amplifiers limit them to their range.

        Raises:
            PhysicsError: a current is not a finite number; the state is left as it was.
        """
        currents = np.asarray(action, float)
        if not np.isfinite(currents).all():
            raise control.PhysicsError(f"the currents must be finite numbers [A], got {currents}")
        physics.set_control(np.clip(currents, LOWEST_CURRENT, HIGHEST_CURRENT))

    def get_observation(self, physics: Physics) -> Mapping[str, np.ndarray]:
        """What the robot measures, and where the handle should be."""
        return OrderedDict(
            motor_angle=physics.motor_angle(),
            motor_rate=physics.motor_rate(),
            position=physics.handle_position(),
            orientation=physics.handle_orientation(),
            tension=physics.tension(),
            target=physics.target(),
        )

    def get_reward(self, physics: Physics) -> float:
        """The reward between 0 and 1: it is 1 near the target and upright."""
        distance = np.linalg.norm(physics.handle_position() - physics.target())
        angle = 2 * np.arccos(np.clip(abs(physics.handle_orientation()[0]), 0, 1))
        near = rewards.tolerance(distance, (0, NEAR), NEAR_MARGIN)
        level = rewards.tolerance(angle, (0, LEVEL), LEVEL_MARGIN)
        return float(near * level)


class Hold(Handle):
    """Keep the handle where it starts, against the constant, unobserved force of a hand."""

    def initialize_episode(self, physics: Physics) -> None:
        """Start an episode, and let the hand pull in a random direction."""
        super().initialize_episode(physics)
        direction = self.random.normal(size=3)
        force = self.random.uniform(*HAND) * direction / np.linalg.norm(direction)
        physics.named.data.xfrc_applied["platform", :3] = force

    def draw_target(self, begin: np.ndarray) -> np.ndarray:
        """The target is the start itself."""
        return begin


class Reach(Handle):
    """Bring the handle to a target that it can hold."""

    def draw_target(self, begin: np.ndarray) -> np.ndarray:
        """A random target in a box about the nominal start."""
        nominal = parameter_set()
        centre = np.array([nominal[n].value for n in "xyz"])
        return centre + self.random.uniform(-REACH, REACH)


TASKS = {"hold": Hold, "reach": Reach}


def load_environment(
    task: str = "hold",
    random: int | np.random.Generator | None = None,
    time_limit: float = TIME_LIMIT,
    environment_kwargs: Mapping[str, Any] | None = None,
) -> control.Environment:
    """An environment with the model file and the law of its cables.

    Args:
        task: "hold" or "reach".
        random: seed, or a generator to draw from.
        time_limit: of an episode [s].
        environment_kwargs: further arguments of `dm_control.rl.control.Environment`.

    Raises:
        InputError: there is no such task, or another library holds MuJoCo's callbacks.
    """
    if task not in TASKS:
        raise unknown_name("task", task, TASKS)
    settings = {"control_timestep": CONTROL_TIMESTEP, **(environment_kwargs or {})}
    return control.Environment(_physics(), TASKS[task](random), time_limit, **settings)


def _physics() -> Physics:
    native.install()
    spec = mujoco.MjSpec.from_file(str(model_path()))
    spec.worldbody.add_site(name=TARGET, size=[0.01, 0.01, 0.01], rgba=[0.1, 0.7, 0.2, 0.6])
    return Physics.from_model(dm_mujoco.wrapper.MjModel(spec.compile()))
