"""Lines in the room, drawn over a picture of it.

q = Qᵀ (p - o)                                o, Q: place and axes of the camera, which looks
column = w/2 - f q_x/q_z                      along -z
row    = h/2 + f q_y/q_z,     f = h / (2 tan(fovy/2))
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, tan

import numpy as np
from PIL import Image, ImageDraw

_NEAR = 0.02  # [m] before the camera, from where on things are drawn
_FAR = 1e5  # [px] outside: a corner there is as little seen as one behind the camera
_FINER = 3  # times as many pixels are drawn, so that edges are smooth


@dataclass(frozen=True)
class Line:
    """A line through corners.

    Attributes:
        corners: in O, shape (M, 3) [m].
        colour: a name or "#rrggbb".
        width: [px].
    """

    corners: np.ndarray
    colour: str
    width: float


@dataclass(frozen=True)
class Eye:
    """A camera.

    Attributes:
        place: o in O, shape (3,) [m].
        axes: Q, its axes to the right, up and backwards as columns, shape (3, 3).
        fovy: its vertical angle of view [rad].
    """

    place: np.ndarray
    axes: np.ndarray
    fovy: float

    def pixels(self, points: np.ndarray, size: tuple[int, int]) -> np.ndarray:
        """Returns pixels of points in O, shape (M, 3) -> (M, 2); NaN for those not before the eye.

        Args:
            points: shape (M, 3) [m].
            size: width and height of the picture [px].
        """
        x, y, z = ((np.asarray(points) - self.place) @ self.axes).T
        f = size[1] / (2 * tan(self.fovy / 2))
        depth = np.where(z < -_NEAR, -z, np.nan)
        return np.stack([size[0] / 2 + f * x / depth, size[1] / 2 - f * y / depth], axis=1)


def overlay(picture: np.ndarray, lines: Sequence[Line], eye: Eye) -> np.ndarray:
    """Returns the picture with lines over it, later ones on top, (height, width, 3) of bytes."""
    image = Image.fromarray(picture)
    for line in lines:
        parts = _parts(eye.pixels(line.corners, image.size))
        box = _box(parts, line.width, image.size)
        if box is None:
            continue
        left, top, right, bottom = box
        fine = Image.new("L", ((right - left) * _FINER, (bottom - top) * _FINER))
        pen, width = ImageDraw.Draw(fine), max(1, round(line.width * _FINER))
        for part in parts:
            at = _FINER * (part - (left, top))
            pen.line([(float(x), float(y)) for x, y in at], fill=255, width=width, joint="curve")
        image.paste(line.colour, box, fine.reduce(_FINER))
    return np.asarray(image)


def _parts(corners: np.ndarray) -> list[np.ndarray]:
    """Returns the pieces between corners that are unseen or far outside, each of shape (K, 2)."""
    seen = np.isfinite(corners).all(axis=1) & (np.abs(corners) < _FAR).all(axis=1)
    pieces = np.split(corners, np.flatnonzero(~seen))
    pieces = [pieces[0], *(piece[1:] for piece in pieces[1:])]  # all but the first begin unseen
    return [piece for piece in pieces if len(piece) > 1]


def _box(
    parts: Sequence[np.ndarray], width: float, size: tuple[int, int]
) -> tuple[int, int, int, int] | None:
    """Returns the box that holds the pieces [px]; None where none is in the picture."""
    if not parts:
        return None
    corners, edge = np.vstack(parts), ceil(width) + 1
    low = np.clip(np.floor(corners.min(axis=0)) - edge, 0, size).astype(int)
    high = np.clip(np.ceil(corners.max(axis=0)) + edge, 0, size).astype(int)
    return (*low.tolist(), *high.tolist()) if (low < high).all() else None
