"""The places of things in a frame of the film, what is written on it, and the plots beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image, ImageDraw, ImageFont

from identification.report.page.style import GREY, INK, MEASURED, SIMULATED
from inca_mj.rendering.legend import (
    ASKED,
    MEASURED_ROBOT,
    ROBOT,
    TRACE,
    Entry,
    TensionScale,
    draw_mark,
    shade,
)
from inca_mj.robot.geometry import DRIVES

Box = tuple[int, int, int, int]  # left, top, width, height [px]
BACKGROUND = (255, 255, 255)
READOUT = 1.1  # size of the numbers that change [em]: 21 pixels in a film of 720
_INCHES = 4.8  # width, so that letters grow with the picture
_CURSOR = np.round(255 * np.array(to_rgb(INK))).astype(np.uint8)


@dataclass(frozen=True)
class Layout:
    """Boxes of a frame; a part that is not shown is None. Without `legend` it is on the scene."""

    scene: Box
    handle: Box | None
    plots: Box | None
    legend: Box | None = None


def layout(size: tuple[int, int], camera: str, plots: bool, titled: bool = False) -> Layout:
    """Returns boxes: the scene on the left; the handle, 15 cm in 3 m, close up; plots below it.

    A high frame has the scene above, beside its legend, and the rest below. A title has a strip
    of its own over all of it.
    """
    width, height = size
    closeup = camera != "handle"
    strip = 2 * em_of(height) if titled else 0
    if width < height and (closeup or plots):
        top = strip + (height - strip) * 11 // 20
        low, half = height - top, width // 2 if closeup and plots else 0
        handle = (0, top, width - half, low) if closeup else None
        beside = (width - (half or width), top, half or width, low) if plots else None
        legend = min(13 * em_of(height), width // 2)
        scene = (legend, strip, width - legend, top - strip)
        return Layout(scene, handle, beside, (0, strip, legend, top - strip))
    if not plots:
        w, h = width * 3 // 10, height * 4 // 10
        corner = (width - w - 12, height - h - 12, w, h)
        return Layout((0, strip, width, height - strip), corner if closeup else None, None)
    column = width * 3 // 8
    top = strip + (height - strip) * 2 // 5 if closeup else strip
    left = width - column
    handle = (left, strip, column, top - strip) if closeup else None
    return Layout((0, strip, left, height - strip), handle, (left, top, column, height - top))


def em_of(height: int) -> int:
    """Returns the size of letters in a frame of a height [px]."""
    return max(8, round(height / 38))


def font_of(size: int) -> ImageFont.FreeTypeFont:
    """Returns the font that matplotlib brings, so that every machine writes alike; size [px]."""
    return ImageFont.truetype(
        Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"), size
    )


def paste(frame: np.ndarray, box: Box, picture: np.ndarray) -> None:
    """Put a picture (h, w, 3) into its box of a frame, in place."""
    left, top, width, height = box
    frame[top : top + height, left : left + width] = picture


class Lettering:
    """The words on every frame, drawn once, and the clock, drawn each time."""

    def __init__(
        self,
        size: tuple[int, int],  # width and height of the frame [px]
        boxes: Layout,
        scale: TensionScale,
        *,
        ghost: bool,  # whether there is a measured robot
        assumed: bool,  # whether the geometry is
        magnify: float | None,  # of a trace's deviation; None where there is no trace
        times: float,  # by how much the close view enlarges the difference from the measured robot
        title: str,  # stands over the picture; nothing when empty
    ) -> None:
        """Draw what does not change."""
        self._em = em_of(size[1])
        area = boxes.legend or boxes.scene
        image = Image.new("RGBA", size, (*BACKGROUND, 0))
        pen = ImageDraw.Draw(image)
        left, top, width, height = area
        em, below = self._em, top + height
        robots = [*ROBOT, *([MEASURED_ROBOT] if ghost else [])]
        high = int((3.0 + 1.4 * len(robots) + (4.6 if ghost else 0.0)) * em)
        self._card(pen, left, top, int(12.5 * em), high)
        self._clock = (left + em, top + em)
        self._legend(pen, robots, left + em, top + int(3.5 * em))
        self._readout = self._clock
        row = top + int((3.1 + 1.4 * len(robots)) * em)
        self._off = (left + em, row + int(1.3 * em))
        if ghost:
            pen.text((left + em, row), "off the measured robot", INK, self._font(0.8))
        if magnify is not None:  # beside the clock's card where there is room, else under it
            beside = width >= 26 * em
            at = (left + int(12.5 * em), top) if beside else (left, top + high)
            text = f"trace, error × {magnify:g}"
            paths = [Entry("asked path", (ASKED,), 0.08), Entry(text, (TRACE,), 0.14)]
            self._card(pen, *at, int(12.5 * em), int(4.8 * em))
            self._legend(pen, paths, at[0] + em, at[1] + int(1.05 * em))
            self._readout = (at[0] + em, at[1] + int(3.25 * em))
        self._card(pen, left, below - int(5.0 * em), int(12.5 * em), int(5.0 * em))
        self._bar(image, pen, area, scale)
        if assumed:
            at = (left + em, below - int(0.9 * em))
            pen.text(at, "geometry assumed", INK, self._font(0.7), anchor="ls")
        if boxes.handle is not None:
            left, top, width, height = boxes.handle
            pen.rectangle((left, top, left + width - 1, top + height - 1), outline="#C9CED4")
            self._caption(pen, left, top, width, times)
        shown, font = title, self._font(1.15)
        while shown and pen.textlength(shown, font) > size[0] - 2 * em:  # as much as has room
            shown = shown.removesuffix("…")[:-1] + "…" if len(shown) > 1 else ""
        pen.text((em, em), shown, INK, font, anchor="lm")
        pixels = np.asarray(image, np.uint16).reshape(-1, 4)
        self._where = np.flatnonzero(pixels[:, 3])
        alpha = pixels[self._where, 3:]
        self._ink, self._see = pixels[self._where, :3] * alpha, 255 - alpha

    def write(self, frame: np.ndarray, time: float, distance: float | None = None,
              off: np.ndarray | None = None) -> None:  # fmt: skip
        """Letters a frame in place: time [s], distance from the path [m], errors [m, rad]."""
        each = frame.reshape(-1, 3)
        each[self._where] = (self._ink + each[self._where] * self._see) // 255
        self._say(frame, self._clock, f"t = {time:z.2f} s", 1.15)
        if off is not None:
            left, top = self._off
            self._say(frame, (left, top), f"platform {1e3 * off[0]:.2f} mm", READOUT)
            row = top + int(1.55 * self._em)
            self._say(frame, (left, row), f"motors {1e3 * off[1]:.1f} mrad", READOUT)
        if distance is not None:
            self._say(frame, self._readout, f"error {1e3 * distance:.3f} mm", READOUT)

    def _say(self, frame: np.ndarray, at: tuple[int, int], text: str, ems: float) -> None:
        left, top = at
        corner = frame[top : top + 2 * self._em, left : left + int(11.5 * self._em)]
        image = Image.fromarray(corner)
        ImageDraw.Draw(image).text((0, 0), text, INK, self._font(ems))
        corner[:] = np.asarray(image)

    def _caption(self, pen: ImageDraw.ImageDraw, left: int, top: int, room: int,
                 times: float) -> None:  # fmt: skip
        """Writes what the close view shows and by how much it enlarges, in as many words as fit."""
        lines, font = ["handle"], self._font(0.8)
        if times != 1:
            lines = [f"handle; blue: difference drawn {times:g} times", f"difference × {times:g}"]
        each = [int(pen.textlength(text, font)) + self._em for text in lines]
        fits = next((k for k, wide in enumerate(each) if wide < room), len(lines) - 1)
        self._card(pen, left, top, each[fits], 2 * self._em)
        pen.text((left + 2 * self._em // 3, top + self._em), lines[fits], INK, font, anchor="lm")

    def _font(self, ems: float) -> ImageFont.FreeTypeFont:
        return font_of(max(6, round(ems * self._em)))

    def _card(self, pen: ImageDraw.ImageDraw, left: int, top: int, width: int, height: int) -> None:
        """Draws a pale ground that keeps letters readable where the robot passes behind them."""
        inset = self._em // 3
        box = (left + inset, top + inset, left + width, top + height - inset)
        pen.rounded_rectangle(box, inset, fill=(255, 255, 255, 170))

    def _legend(self, pen: ImageDraw.ImageDraw, rows: Sequence[Entry], left: int,
                top: int) -> None:  # fmt: skip
        em = self._em
        for row, entry in enumerate(rows):
            y = top + int(1.4 * em * row)
            draw_mark(pen, entry, left, y, em)
            pen.text((left + int(1.7 * em), y), entry.text, INK, self._font(0.85), anchor="lm")

    def _bar(self, image: Image.Image, pen: ImageDraw.ImageDraw, box: Box,
             scale: TensionScale) -> None:  # fmt: skip
        em = self._em
        width, height = 11 * em, max(4, em // 2)
        left, top = box[0] + em, box[1] + box[3] - int(3.6 * em)
        colours = np.round(255 * shade(np.linspace(0, 1, width))).astype(np.uint8)
        image.paste(Image.fromarray(np.tile(colours, (height, 1, 1)), "RGBA"), (left, top))
        font = self._font(0.7)
        pen.text((left, top - em // 4), "cables: tension [N]; grey: slack", INK, font, anchor="ls")
        y = top + height + em // 4
        for part, anchor in ((0.0, "la"), (0.5, "ma"), (1.0, "ra")):
            value = scale.low + part * (scale.high - scale.low)
            pen.text((left + int(part * width), y), f"{value:zg}", INK, font, anchor=anchor)


class Panel:
    """Motor angles of the eight drives over time, as pixels."""

    def __init__(self, time: np.ndarray, simulated: np.ndarray, measured: np.ndarray | None,
                 size: tuple[int, int]) -> None:  # fmt: skip
        """Draws motor angles (N, 8) [rad] over times (N,) [s]; size is width and height [px]."""
        dpi = size[0] / _INCHES
        figure = Figure((_INCHES, size[1] / dpi), dpi=dpi)
        canvas = FigureCanvasAgg(figure)
        axes = figure.subplots(DRIVES // 2, 2, sharex=True)
        # Low drives on the left, high ones on the right, as 1 and 5 share an edge of the frame.
        for k, ax in enumerate(axes.T.flat):
            if measured is not None:
                ax.plot(time, measured[:, k], color=MEASURED, lw=2.2, alpha=0.55)
            ax.plot(time, simulated[:, k], color=SIMULATED, lw=0.9)
            ax.set_title(f"φ{chr(0x2081 + k)}", fontsize=8, color=INK, pad=1.5, loc="left")
            ax.tick_params(labelsize=6, color=GREY, labelcolor=INK, length=2, pad=1.5)
            ax.locator_params(axis="y", nbins=3)
            ax.spines[["top", "right"]].set_visible(False)
            ax.spines[["left", "bottom"]].set_color(GREY)
            ax.set_xlim(time[0], time[-1])
        inch = dpi / size[1]  # in parts of the height
        figure.suptitle("motor angles [rad] over time [s]", fontsize=8.5, color=INK, va="center",
                        x=0.03, ha="left", y=1 - 0.14 * inch)  # fmt: skip
        lines = [Line2D([], [], color=SIMULATED, lw=0.9)]
        if measured is not None:
            lines.append(Line2D([], [], color=MEASURED, lw=2.2, alpha=0.55))
        figure.legend(lines, ["simulated", "measured"][: len(lines)], fontsize=7, frameon=False,
                      loc="upper right", ncols=2, borderaxespad=0.1)  # fmt: skip
        figure.subplots_adjust(left=0.08, right=0.97, top=1 - 0.45 * inch, bottom=0.26 * inch,
                               hspace=0.5, wspace=0.18)  # fmt: skip
        canvas.draw()
        self._still = np.asarray(canvas.buffer_rgba())[..., :3].copy()
        self._time = float(time[0]), float(time[-1])
        # Pixel rows count from the top, matplotlib's from the bottom.
        boxes = [ax.get_window_extent().extents for ax in axes.flat]
        self._boxes = [(x0, size[1] - y1, x1, size[1] - y0) for x0, y0, x1, y1 in boxes]

    def at(self, time: float) -> np.ndarray:
        """Returns the plots with the cursor at a time [s], shape (height, width, 3) of bytes."""
        picture = self._still.copy()
        first, last = self._time
        part = (time - first) / (last - first)
        for x0, y0, x1, y1 in self._boxes:
            x = round(x0 + part * (x1 - x0))
            picture[int(y0) : int(y1), x : x + 1] = _CURSOR
        return picture
