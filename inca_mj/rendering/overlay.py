"""Lines in the room, drawn over a picture of it: the path asked of the platform, and its trace.

q = Qᵀ (p - o)                                o, Q: place and axes of the camera, which looks
column = w/2 - f q_x/q_z                      along -z
row    = h/2 + f q_y/q_z,     f = h / (2 tan(fovy/2))

e = p - p_d        true position less that asked
p_d + k e          is drawn: a deviation of 2 mm is nothing in a frame of 3 m, 20 times it is seen
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, tan

import numpy as np
from PIL import Image, ImageDraw

from inca_mj.rendering.legend import ASKED, HALO, TRACE
from inca_mj.twin.run import Run

MAGNIFY = 20.0  # k
LAST = 5.0  # [s] that a trace shows: less than a turn at 1 rad/s
_FINE = 0.02  # [s] between corners of a line
_MOST = 2000  # corners of a line, of a long run too
_NEAR = 0.02  # [m] before the camera, from where on things are drawn
_FAR = 1e5  # [px] outside: a corner there is as little seen as one behind the camera
FINER = 3  # times as many pixels are drawn, so that edges are smooth

Box = tuple[int, int, int, int]  # left, top, right, bottom [px]


@dataclass(frozen=True)
class Eye:
    """A camera."""

    place: np.ndarray  # o in O, shape (3,) [m]
    axes: np.ndarray  # Q, its axes to the right, up and backwards as columns, shape (3, 3)
    fovy: float  # its vertical angle of view [rad]

    def pixels(self, points: np.ndarray, size: tuple[int, int]) -> np.ndarray:
        """Returns pixels (M, 2) of points (M, 3) [m] in O; NaN if they are not before the eye."""
        x, y, z = ((np.asarray(points) - self.place) @ self.axes).T
        f = size[1] / (2 * tan(self.fovy / 2))
        depth = np.where(z < -_NEAR, -z, np.nan)
        return np.stack([size[0] / 2 + f * x / depth, size[1] / 2 - f * y / depth], axis=1)


@dataclass(frozen=True)
class Line:
    """A line through corners."""

    corners: np.ndarray  # in O, shape (M, 3) [m]
    colour: str  # a name or "#rrggbb"
    width: float  # [px]


def overlay(picture: np.ndarray, lines: Sequence[Line], eye: Eye) -> np.ndarray:
    """Returns the picture with lines over it, later ones on top, (height, width, 3) of bytes."""
    image = Image.fromarray(picture)
    for line in lines:
        parts = _parts(eye.pixels(line.corners, image.size))
        box = parts and box_of(np.vstack(parts), ceil(line.width) + 1, image.size)
        if not box:
            continue
        left, top, right, bottom = box
        fine = Image.new("L", ((right - left) * FINER, (bottom - top) * FINER))
        pen, width = ImageDraw.Draw(fine), max(1, round(line.width * FINER))
        for part in parts:
            at = FINER * (part - (left, top))
            pen.line([(float(x), float(y)) for x, y in at], fill=255, width=width, joint="curve")
        image.paste(line.colour, box, fine.reduce(FINER))
    return np.asarray(image)


def _parts(corners: np.ndarray) -> list[np.ndarray]:
    """Returns the pieces between corners that are unseen or far outside, each of shape (K, 2)."""
    seen = np.isfinite(corners).all(axis=1) & (np.abs(corners) < _FAR).all(axis=1)
    pieces = np.split(corners, np.flatnonzero(~seen))
    pieces = [pieces[0], *(piece[1:] for piece in pieces[1:])]  # all but the first begin unseen
    return [piece for piece in pieces if len(piece) > 1]


def box_of(corners: np.ndarray, room: int, size: tuple[int, int]) -> Box | None:
    """Returns the box of corners (K, 2) [px], wider by some room; None where it is not seen."""
    low = np.clip(np.floor(corners.min(axis=0)) - room, 0, size).astype(int)
    high = np.clip(np.ceil(corners.max(axis=0)) + room, 0, size).astype(int)
    return (*low.tolist(), *high.tolist()) if (low < high).all() else None


@dataclass(frozen=True)
class Trace:
    """The trace of a platform that follows what is asked."""

    time: np.ndarray  # sample times, shape (N,) [s]
    asked: np.ndarray  # positions asked of the platform, shape (N, 3) [m]
    error: np.ndarray  # true positions less those, shape (N, 3) [m]
    magnify: float = MAGNIFY  # k, by which the error is drawn larger

    def distance(self, at: float) -> float:
        """Returns the distance from what is asked at a time [s], linear between samples [m]."""
        return float(np.linalg.norm(between(self.time, self.error, at)))

    def lines(self, at: float, thickness: float) -> tuple[Line, ...]:
        """Returns the trace of the last seconds, the path, and a line from trace to target."""
        step = max(1, round(_FINE / (self.time[1] - self.time[0])), ceil(len(self.time) / _MOST))
        corners = np.union1d(np.arange(0, len(self.time), step), [len(self.time) - 1])
        times = self.time[corners]
        shown = corners[(times >= at - LAST) & (times < at)]
        asked, error = between(self.time, self.asked, at), between(self.time, self.error, at)
        end = asked + self.magnify * error
        trace = np.vstack([self.asked[shown] + self.magnify * self.error[shown], end])
        return (
            Line(trace, HALO, 4 * thickness),
            Line(trace, TRACE, 2.5 * thickness),
            Line(self.asked[corners], ASKED, thickness),  # over a trace that hardly leaves it
            Line(np.array([asked, end]), TRACE, thickness),
        )


def trace_of(run: Run, magnify: float = MAGNIFY) -> Trace | None:
    """Returns the trace of a run; None where nothing was asked."""
    if run.asked is None:
        return None
    return Trace(run.time, run.asked, run.position - run.asked, magnify)


def between(time: np.ndarray, values: np.ndarray, at: float) -> np.ndarray:
    """Returns values (N, m) interpolated linearly at a time; drawing norms quaternions."""
    k = int(np.clip(np.searchsorted(time, at, "right") - 1, 0, len(time) - 2))
    part = (at - time[k]) / (time[k + 1] - time[k])
    first, last = values[k], values[k + 1].copy()
    if values.shape[1] == 15 and first[3:7] @ last[3:7] < 0:
        last[3:7] *= -1  # the same rotation, the short way round
    return (1 - part) * first + part * last
