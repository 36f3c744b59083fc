"""Colours of the film, and the legend that says what each colour and mark of the robot is."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor

import numpy as np
from PIL import ImageDraw

from identification.report.page.style import MEASURED

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


@dataclass(frozen=True)
class Entry:
    """A row of the legend."""

    text: str  # beside the mark
    # of the mark, from left to right; none is the measured robot's outline and cable
    colours: tuple[str, ...]
    half: float = 0.33  # half of the mark's height [em]


ROBOT = (
    Entry("handle, drum marks", (HANDLE,)),
    Entry("arms with cable ends", (DRUMS, FRAME, FRAME, DRUMS), 0.2),
    Entry("frame", (FRAME,)),
    Entry("drums and motors", (DRUMS, MOTORS)),
)
MEASURED_ROBOT = Entry("measured robot", ())


def draw_mark(pen: ImageDraw.ImageDraw, entry: Entry, left: int, y: int, em: int) -> None:
    """Draws the mark of an entry: its left edge, its middle, and the size of letters [px]."""
    width, half = int(1.2 * em), max(1, int(entry.half * em))
    corner, parts = min(half, em // 4), len(entry.colours)
    if parts == 1:
        box = (left, y - half, left + width, y + half)
        pen.rounded_rectangle(box, corner, fill=entry.colours[0])
        return
    for k, colour in enumerate(entry.colours):
        begin, end = (left + width * n // parts for n in (k, k + 1))
        pen.rectangle((begin, y - half, end, y + half), fill=colour)
    if not parts:
        thick = max(1, em // 6)
        outline = (left, y - half, left + width * 6 // 10, y + half)
        pen.rounded_rectangle(outline, corner, outline=MEASURED, width=thick)
        for tenth in (7, 9):
            dash = (left + width * tenth // 10, y, left + width * (tenth + 1) // 10, y)
            pen.line(dash, MEASURED, max(1, thick * 2 // 3))
