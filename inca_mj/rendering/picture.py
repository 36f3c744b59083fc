"""Where things stand in a frame of the film, and what is written on it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from identification.report.style import INK, MEASURED, SIMULATED
from inca_mj.rendering.colours import TensionScale, shade

Box = tuple[int, int, int, int]  # left, top, width, height [px]
BACKGROUND = (255, 255, 255)


@dataclass(frozen=True)
class Layout:
    """Boxes of a frame; a part that is not shown is None."""

    scene: Box
    handle: Box | None
    plots: Box | None


def layout(size: tuple[int, int], camera: str, plots: bool) -> Layout:
    """The scene on the left; the handle, 15 cm in 3 m, close up; plots below it."""
    width, height = size
    closeup = camera != "handle"
    if not plots:
        w, h = width * 3 // 10, height * 4 // 10
        corner = (width - w - 12, height - h - 12, w, h)
        return Layout((0, 0, width, height), corner if closeup else None, None)
    column = width * 3 // 8
    top = height * 2 // 5 if closeup else 0
    left = width - column
    handle = (left, 0, column, top) if closeup else None
    return Layout((0, 0, left, height), handle, (left, top, column, height - top))


def paste(frame: np.ndarray, box: Box, picture: np.ndarray) -> None:
    """Put a picture (h, w, 3) into its box of a frame, in place."""
    left, top, width, height = box
    frame[top : top + height, left : left + width] = picture


class Lettering:
    """What is written on every frame, drawn once, and the clock, drawn each time."""

    def __init__(self, size: tuple[int, int], boxes: Layout, scale: TensionScale, ghost: bool,
                 assumed: bool) -> None:  # fmt: skip
        self._em = max(8, round(size[1] / 42))
        self._at = (boxes.scene[0] + self._em, boxes.scene[1] + self._em)
        image = Image.new("RGBA", size, (*BACKGROUND, 0))
        pen = ImageDraw.Draw(image)
        left, top, width, height = boxes.scene
        em, below = self._em, top + height
        self._card(pen, left, top, int(12.5 * em), int(5.8 * em if ghost else 4.4 * em))
        self._card(pen, left, below - int(5.0 * em), int(12.5 * em), int(5.0 * em))
        self._legend(pen, ghost)
        self._bar(image, pen, boxes.scene, scale)
        if assumed:
            at = (left + em, below - int(0.9 * em))
            pen.text(at, "geometry assumed", INK, self._font(0.7), anchor="ls")
        if boxes.handle is not None:
            left, top, width, height = boxes.handle
            pen.rectangle((left, top, left + width - 1, top + height - 1), outline="#C9CED4")
            pen.text((left + self._em // 2, top + self._em // 2), "handle", INK, self._font(0.75))
        pixels = np.asarray(image, np.uint16)
        self._rows = np.flatnonzero(pixels[..., 3].any(axis=1))
        alpha = pixels[self._rows][..., 3:]
        self._ink, self._see = pixels[self._rows][..., :3] * alpha, 255 - alpha

    def write(self, frame: np.ndarray, time: float) -> None:
        """Letter a frame (h, w, 3) of time [s], in place."""
        frame[self._rows] = (self._ink + frame[self._rows] * self._see) // 255
        left, top = self._at
        corner = frame[top : top + 2 * self._em, left : left + 9 * self._em]
        image = Image.fromarray(corner)
        ImageDraw.Draw(image).text((0, 0), f"t = {time:.2f} s", INK, self._font(1.15))
        corner[:] = np.asarray(image)

    def _font(self, ems: float) -> ImageFont.FreeTypeFont:
        # matplotlib brings this font, so that every machine writes alike.
        file = Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")
        return ImageFont.truetype(file, max(6, round(ems * self._em)))

    def _card(self, pen: ImageDraw.ImageDraw, left: int, top: int, width: int, height: int) -> None:
        """A pale ground that keeps letters readable where the robot passes behind them."""
        inset = self._em // 3
        box = (left + inset, top + inset, left + width, top + height - inset)
        pen.rounded_rectangle(box, inset, fill=(255, 255, 255, 170))

    def _legend(self, pen: ImageDraw.ImageDraw, ghost: bool) -> None:
        em, (left, top) = self._em, self._at
        lines = [("simulated", SIMULATED), *([("measured", MEASURED)] if ghost else [])]
        for row, (text, colour) in enumerate(lines):
            y = top + int(2.5 * em + 1.4 * em * row)
            pen.rounded_rectangle((left, y - em // 3, left + int(1.2 * em), y + em // 3), em // 4,
                                  fill=colour)  # fmt: skip
            pen.text((left + int(1.7 * em), y), text, INK, self._font(0.85), anchor="lm")

    def _bar(self, image: Image.Image, pen: ImageDraw.ImageDraw, box: Box,
             scale: TensionScale) -> None:  # fmt: skip
        em = self._em
        width, height = 11 * em, max(4, em // 2)
        left, top = box[0] + em, box[1] + box[3] - int(3.6 * em)
        colours = np.round(255 * shade(np.linspace(0, 1, width))).astype(np.uint8)
        image.paste(Image.fromarray(np.tile(colours, (height, 1, 1)), "RGBA"), (left, top))
        font = self._font(0.7)
        pen.text((left, top - em // 4), "tension [N]; grey: slack", INK, font, anchor="ls")
        y = top + height + em // 4
        for part, anchor in ((0.0, "la"), (0.5, "ma"), (1.0, "ra")):
            value = scale.low + part * (scale.high - scale.low)
            pen.text((left + int(part * width), y), f"{value:g}", INK, font, anchor=anchor)
