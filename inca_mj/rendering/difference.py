"""The measured robot drawn farther from the simulated one than it is, by a round factor.

    p = p_s + k (p_m - p_o)              s: simulated, drawn where it is; m: measured
    R = exp(k log(R_m R_oᵀ)) R_s         o: simulated, its pose taken as that of the measured one

A difference of 1 mm is a pixel even close up. Of films side by side k is the same in all pictures,
so that what is drawn compares as what is written.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from scipy.spatial.transform import Rotation

ROOM = 0.12  # how far a part of the handle may be drawn from where it is [m]
_LEVER = 0.12  # length of the handle, at which a turn counts [m]
_MOST = 1000.0  # of a difference that hardly is one
_EACH = (1, 2, 5)


@dataclass(frozen=True)
class Difference:
    """Poses of a simulated and of the measured robot.

    Attributes:
        simulated: MuJoCo positions of the simulated robot, shape (N, 15) [m, -, rad].
        own: the same, its pose taken in the way in which that of the measured robot is known.
        measured: positions of the measured one, shape (N, 15).
    """

    simulated: np.ndarray
    own: np.ndarray
    measured: np.ndarray

    @property
    def moved(self) -> np.ndarray:
        """Displacement of the measured platform, shape (N, 3) [m]."""
        return np.asarray(self.measured[:, :3] - self.own[:, :3])

    @property
    def turned(self) -> np.ndarray:
        """Rotation vector of the measured platform, shape (N, 3) [rad]."""
        return np.asarray((_rotation(self.measured) * _rotation(self.own).inv()).as_rotvec())

    @property
    def largest(self) -> float:
        """The farthest that a part of the handle is off at any time [m]."""
        length = np.linalg.norm(self.moved, axis=1)
        return float(np.max(length + _LEVER * np.linalg.norm(self.turned, axis=1)))

    def enlarged(self, times: float) -> np.ndarray:
        """Returns positions of the measured robot, its difference magnified, shape (N, 15)."""
        out = self.measured.copy()
        out[:, :3] = self.simulated[:, :3] + times * self.moved
        turned = Rotation.from_rotvec(times * self.turned) * _rotation(self.simulated)
        out[:, 3:7] = turned.as_quat(scalar_first=True)
        return out


def common_factor(each: Sequence[Difference]) -> float:
    """Returns the largest of 1, 2, 5, 10, ... with which all differences fit in a close view."""
    largest = max(one.largest for one in each)
    if largest * _MOST <= ROOM:
        return _MOST
    power = floor(log10(ROOM / largest))
    fits = [k * 10.0**power for k in _EACH if k * 10.0**power * largest <= ROOM]
    return max(1.0, *fits)


def _rotation(positions: np.ndarray) -> Rotation:
    return Rotation.from_quat(positions[:, 3:7], scalar_first=True)
