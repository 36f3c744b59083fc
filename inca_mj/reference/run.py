"""The result of a simulation of the reference."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.reference import layout as at


@dataclass(frozen=True)
class ReferenceRun:
    """A trajectory of the reference, sampled; its arrays are read-only.

    Attributes:
        time: sample times, shape (n,) [s].
        state: the 36 states in the order of `layout`, shape (n, 36).
        tension: cable tensions, shape (n, 8) [N].
    """

    time: np.ndarray
    state: np.ndarray
    tension: np.ndarray

    def __post_init__(self) -> None:
        for array in (self.time, self.state, self.tension):
            array.setflags(write=False)

    @property
    def position(self) -> np.ndarray:
        """Position of the platform in O, shape (n, 3) [m]."""
        return self.state[:, at.POSITION]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of the platform along its BODY axes, shape (n, 3) [m/s]."""
        return self.state[:, at.VELOCITY]

    @property
    def euler(self) -> np.ndarray:
        """Roll, pitch and yaw of the platform, shape (n, 3) [rad]."""
        return self.state[:, at.EULER]

    @property
    def rates(self) -> np.ndarray:
        """Angular rate of the platform along its body axes, shape (n, 3) [rad/s]."""
        return self.state[:, at.RATES]

    @property
    def angles(self) -> np.ndarray:
        """Motor angles, positive winds in, shape (n, 8) [rad]."""
        return self.state[:, at.ANGLES]

    @property
    def speeds(self) -> np.ndarray:
        """Motor rates, shape (n, 8) [rad/s]."""
        return self.state[:, at.SPEEDS]

    @property
    def no_load(self) -> np.ndarray:
        """No-load lengths of the free cables, shape (n, 8) [m]."""
        return self.state[:, at.NO_LOAD]
