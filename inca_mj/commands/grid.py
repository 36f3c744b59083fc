"""The points of a grid as a command line names them: NAME=LOW:HIGH:POINTS."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.errors import InputError, unknown_name
from inca_mj.robot.parameters import POSE

MOST = 200  # points of one axis


def grid_axes(words: Sequence[str]) -> dict[str, np.ndarray]:
    """Returns the axes of a grid from words such as `x=-0.4:0.4:5`.

    Args:
        words: each NAME=LOW:HIGH:POINTS; lengths in m, angles in rad.

    Raises:
        InputError: a word is malformed, names no scheduling variable, or names one twice.
    """
    axes: dict[str, np.ndarray] = {}
    for word in words:
        name, equals, rest = word.partition("=")
        parts = rest.split(":")
        try:
            low, high, points = float(parts[0]), float(parts[1]), int(parts[2])
            if not equals or len(parts) != 3:
                raise ValueError
        except (ValueError, IndexError):
            raise InputError(
                f"{word!r} is not NAME=LOW:HIGH:POINTS; write e.g. --grid x=-0.4:0.4:5"
            ) from None
        if name not in POSE:
            raise unknown_name("scheduling variable", name, POSE)
        if name in axes:
            raise InputError(f"--grid gives {name} twice; give it once")
        if not 2 <= points <= MOST:
            raise InputError(f"--grid gives {points} points of {name}; give 2 to {MOST}")
        axes[name] = np.linspace(low, high, points)
    return axes
