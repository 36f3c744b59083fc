"""Colours of the film: the scale of the tensions, the path that was asked, the trace."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor

import numpy as np

SLACK = (0.62, 0.64, 0.66, 1.0)
ASKED = "#009E73"  # green of Okabe and Ito, which no tension has
HANDLE, FRAME, DRUMS, MOTORS = "#ED7321", "#999EA8", "#4C525C", "#1F1F21"  # as the model has them
TRACE = "#111111"
HALO = "#FFFFFF"  # round the trace, which passes dark parts of the robot
# Plasma is perceptually uniform; its last tenth, a bright yellow, is lost on a light background.
_COLORMAP, _END = "plasma", 0.88


def shade(where: np.ndarray) -> np.ndarray:
    """Returns the colours of numbers in 0..1 on the tension scale, shape (..., 4) [0..1]."""
    from matplotlib import colormaps

    return np.asarray(colormaps[_COLORMAP](_END * np.clip(where, 0.0, 1.0)))


@dataclass(frozen=True)
class TensionScale:
    """Tension to colour, from `low` to `high` [N]; a slack cable is grey."""

    low: float
    high: float

    def __call__(self, tension: np.ndarray) -> np.ndarray:
        """Returns the colours of tensions [N], shape (n,) -> (n, 4)."""
        tension = np.asarray(tension, float)
        colours = shade((tension - self.low) / (self.high - self.low))
        colours[tension <= 0] = SLACK
        return colours


def tension_scale(tension: np.ndarray) -> TensionScale:
    """Returns the scale of whole newtons that holds all tensions [N] of the cables that pull."""
    pulling = tension[tension > 0]
    if not len(pulling):
        return TensionScale(0.0, 1.0)
    low, high = floor(pulling.min()), ceil(pulling.max())
    return TensionScale(float(low), float(max(high, low + 1)))
