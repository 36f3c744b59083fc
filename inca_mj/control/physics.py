"""The twin as dm_control's Physics, with names for what the robot measures and its user sees."""

from __future__ import annotations

import warnings

import numpy as np

from inca_mj.robot import law
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.mjcf import build
from inca_mj.twin.statics import Start
from inca_mj.twin.twin import Twin, start_state

with warnings.catch_warnings():
    # dm_control tries GLFW while it is imported, which prints warnings without a display.
    warnings.filterwarnings("ignore", ".*DISPLAY")
    from dm_control import mujoco as dm_mujoco

TARGET = "target"


class Physics(dm_mujoco.Physics):
    """The twin under dm_control; `reset` puts it to its pretensioned rest.

    Attributes:
        rest: the start of the twin, None for a model that was loaded without one.
    """

    rest: Start | None = None

    def reset(self, keyframe_id: int | None = None) -> None:
        """Put the robot to rest at its start, where it can be stepped at once.

        Args:
            keyframe_id: another keyframe of the model.
        """
        if self.rest is not None:
            self.model.actuator_user[:, law.T_0] = self.rest.balance
        super().reset(int(self.model.key("start").id) if keyframe_id is None else keyframe_id)

    def copy(self, share_model: bool = False) -> Physics:
        """Returns a copy with the same state and rest.

        Args:
            share_model: whether both have one model.
        """
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

    def motor_rate(self) -> np.ndarray:
        """Returns the true motor rates ω, shape (8,) [rad/s]."""
        return self._drives("rate")

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
