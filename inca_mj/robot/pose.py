"""The pose of the platform by the names of the robot's parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

from identification.errors import InputError

POSE = ("x", "y", "z", "roll", "pitch", "yaw")


def pose_values(pose: Sequence[float]) -> Mapping[str, float]:
    """Returns a pose by the names of the robot's parameters.

    Args:
        pose: x, y, z [m], roll, pitch, yaw [rad].

    Raises:
        InputError: it is not six finite numbers.
    """
    try:
        numbers = [float(number) for number in pose]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != len(POSE) or not all(map(isfinite, numbers)):
        raise InputError(
            f"a pose is six finite numbers, x y z [m] roll pitch yaw [rad]; got {pose!r}"
        )
    return dict(zip(POSE, numbers, strict=True))
