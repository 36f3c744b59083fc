"""The legend of a film: what each colour and mark of the robot is."""

from __future__ import annotations

from dataclasses import dataclass

from PIL import ImageDraw

from identification.report.style import MEASURED
from inca_mj.rendering.colours import DRUMS, FRAME, HANDLE, MOTORS


@dataclass(frozen=True)
class Entry:
    """A row of the legend.

    Attributes:
        text: beside the mark.
        colours: of the mark, from left to right; none is the measured robot's outline and cable.
        half: half of the mark's height [em].
    """

    text: str
    colours: tuple[str, ...]
    half: float = 0.33


ROBOT = (
    Entry("handle, drum marks", (HANDLE,)),
    Entry("arms with cable ends", (DRUMS, FRAME, FRAME, DRUMS), 0.2),
    Entry("frame", (FRAME,)),
    Entry("drums and motors", (DRUMS, MOTORS)),
)
MEASURED_ROBOT = Entry("measured robot", ())


def draw_mark(pen: ImageDraw.ImageDraw, entry: Entry, left: int, y: int, em: int) -> None:
    """Draw the mark of an entry.

    Args:
        pen: of the picture.
        entry: which.
        left: edge of the mark [px].
        y: its middle [px].
        em: size of letters [px].
    """
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
