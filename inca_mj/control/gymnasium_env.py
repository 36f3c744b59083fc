"""The tasks as a Gymnasium environment: `load_gymnasium("track", seed)`.

It is the dm_control environment with Gymnasium's words: the same steps give the same numbers. An
episode is truncated at its time limit and never terminated. The module needs dm_control and
gymnasium: pip install inca-mj[control].
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from dm_control.rl import control

from inca_mj.control.environment import load_environment


class GymnasiumEnv(gymnasium.Env[Any, np.ndarray]):
    """One task of the robot for Gymnasium; `load_gymnasium` makes it."""

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 100}  # noqa: RUF012

    def __init__(
        self, task: str = "hold", seed: int | None = None, render_mode: str | None = None,
        **options: Any,
    ) -> None:  # fmt: skip
        self.wrapped: control.Environment = load_environment(task, seed, **options)
        self.render_mode = render_mode
        self.metadata = {
            **self.metadata,
            "render_fps": round(1 / self.wrapped.control_timestep()),
        }
        action = self.wrapped.action_spec()
        self.action_space = gymnasium.spaces.Box(action.minimum, action.maximum, dtype=np.float64)
        self.wrapped.reset()  # dm_control knows the observations' shapes after a reset only
        self.observation_space = gymnasium.spaces.Dict(
            {
                name: gymnasium.spaces.Box(-np.inf, np.inf, spec.shape, spec.dtype)
                for name, spec in self.wrapped.observation_spec().items()
            }
        )
        self.wrapped.task.random = np.random.default_rng(seed)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Begins an episode; a seed is that of this and all following ones. It has no options."""
        super().reset(seed=seed)
        if seed is not None:
            self.wrapped.task.random = np.random.default_rng(seed)
        return dict(self.wrapped.reset().observation), {}

    def step(
        self, action: np.ndarray
    ) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """Gives the motors currents (8,) [A] for a step; episodes are truncated, never terminated.

        Raises PhysicsError if a current is not a finite number.
        """
        step = self.wrapped.step(action)
        return dict(step.observation), float(step.reward), False, step.last(), {}

    def render(self) -> np.ndarray | None:
        """Returns a picture, shape (240, 320, 3) of bytes; None without a render mode."""
        if self.render_mode is None:
            return None
        return np.asarray(self.wrapped.physics.render(240, 320, camera_id="front"))

    def close(self) -> None:
        """Free what was drawn with."""
        self.wrapped.close()


def load_gymnasium(
    task: str = "hold", seed: int | None = None, render_mode: str | None = None, **options: Any
) -> GymnasiumEnv:
    """Returns a Gymnasium environment with a robot and a task.

    Args:
        task: "hold", "reach" or "track".
        seed: of the episodes; `reset(seed=...)` gives another.
        render_mode: "rgb_array", or None.
        options: further arguments of `load_environment`.

    Raises:
        InputError: for the reasons of `load_environment`.
    """
    return GymnasiumEnv(task, seed, render_mode, **options)
