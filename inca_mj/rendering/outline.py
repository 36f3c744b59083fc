"""The measured robot as an outline: a line round what moves, and thin broken cables.

A sphere of radius r at c is seen as a circle: c + r (cos α, sin α) in the plane of the picture; a
capsule as the convex hull of the circles of its two ends. The outline goes round all of them
together. It covers none of what lies inside, so that both robots are seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np
from PIL import Image, ImageChops, ImageDraw, ImageFilter
from scipy.spatial import ConvexHull, QhullError

from inca_mj.rendering.overlay import Eye

_CIRCLE = np.linspace(0, 2 * np.pi, 24, endpoint=False)
_SPHERE, _CAPSULE = int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_CAPSULE)
_FINER = 3  # times as many pixels are drawn, so that edges are smooth
_DASH, _GAP = 7.0, 6.0  # of a broken line [px of 480 rows]


@dataclass(frozen=True)
class Outline:
    """What is drawn of a robot, in pixels.

    Attributes:
        shapes: convex polygons, shape (K, 2) each.
        cables: their corners, shape (K, 2) each.
    """

    shapes: tuple[np.ndarray, ...]
    cables: tuple[np.ndarray, ...]


def outline_of(
    model: mujoco.MjModel, data: mujoco.MjData, eye: Eye, size: tuple[int, int]
) -> Outline:
    """The outline of a robot that was placed.

    Args:
        model: with bodies of spheres and capsules; drums, which are cylinders, stay where they are.
        data: its positions, tendons included.
        eye: the camera.
        size: width and height of the picture [px].
    """
    shapes = []
    for i in np.flatnonzero(model.body_weldid[model.geom_bodyid] != 0).tolist():
        if int(model.geom_type[i]) in (_SPHERE, _CAPSULE):
            corners = eye.pixels(_round(model, data, i, eye), size)
            if np.isfinite(corners).all():
                shapes.append(_hull(corners))
    cables = []
    for k in range(model.ntendon):
        first, count = int(data.ten_wrapadr[k]), int(data.ten_wrapnum[k])
        points = data.wrap_xpos.reshape(-1, 3)[first : first + count]
        corners = eye.pixels(points, size)
        if np.isfinite(corners).all():
            cables.append(corners)
    return Outline(tuple(shapes), tuple(cables))


def draw_outline(picture: np.ndarray, outline: Outline, colour: str, width: float) -> np.ndarray:
    """The picture with the outline over it, shape (height, width, 3) of bytes.

    Args:
        picture: shape (height, width, 3) of bytes.
        outline: what to draw.
        colour: "#rrggbb".
        width: of its lines [px].
    """
    image = Image.fromarray(picture)
    mask = Image.new("L", image.size)
    pen = ImageDraw.Draw(mask)
    for corners in outline.cables:
        for part in _broken(corners, max(1.0, image.size[1] / 480)):
            pen.line([*map(tuple, part.tolist())], fill=170, width=max(1, round(width / 2)))
    image.paste(colour, (0, 0), mask)
    for box, edge in _edges(outline.shapes, image.size, width):
        image.paste(colour, box, edge)
    return np.asarray(image)


def _edges(
    shapes: Sequence[np.ndarray], size: tuple[int, int], width: float
) -> Iterator[tuple[tuple[int, int, int, int], Image.Image]]:
    """The line round all shapes together, and the part of the picture in which it lies [px]."""
    if not shapes:
        return
    corners, room = np.vstack(shapes), round(width) + 2
    low = np.clip(np.floor(corners.min(axis=0)) - room, 0, size).astype(int)
    high = np.clip(np.ceil(corners.max(axis=0)) + room, 0, size).astype(int)
    if not (low < high).all():
        return
    fine = Image.new("L", tuple((_FINER * (high - low)).tolist()))
    pen = ImageDraw.Draw(fine)
    for shape in shapes:
        pen.polygon([*map(tuple, (_FINER * (shape - low)).tolist())], fill=255)
    wider = fine.filter(ImageFilter.MaxFilter(2 * max(1, round(_FINER * width / 2)) + 1))
    narrower = fine.filter(ImageFilter.MinFilter(2 * max(1, round(_FINER * width / 2)) + 1))
    edge = ImageChops.subtract(wider, narrower).reduce(_FINER)
    yield (int(low[0]), int(low[1]), int(high[0]), int(high[1])), edge


def _round(model: mujoco.MjModel, data: mujoco.MjData, i: int, eye: Eye) -> np.ndarray:
    """Points on the rim of a sphere or a capsule, shape (K, 3) [m]."""
    right, up = eye.axes[:, 0], eye.axes[:, 1]
    radius, half = model.geom_size[i, :2]
    rim = radius * (np.cos(_CIRCLE)[:, None] * right + np.sin(_CIRCLE)[:, None] * up)
    if model.geom_type[i] == _SPHERE:
        return np.asarray(data.geom_xpos[i] + rim)
    axis = half * data.geom_xmat[i].reshape(3, 3)[:, 2]
    return np.vstack([data.geom_xpos[i] + end + rim for end in (axis, -axis)])


def _hull(corners: np.ndarray) -> np.ndarray:
    try:
        return np.asarray(corners[ConvexHull(corners).vertices])
    except QhullError:  # all in one pixel
        return corners


def _broken(corners: np.ndarray, scale: float) -> list[np.ndarray]:
    """The dashes of a line through corners (K, 2), each of shape (2, 2)."""
    out = []
    for a, b in pairwise(corners):
        length = float(np.linalg.norm(b - a))
        begins = np.arange(0.0, length, (_DASH + _GAP) * scale)
        for s in begins if length > 0 else ():
            out.append(a + np.array([[s], [min(s + _DASH * scale, length)]]) / length * (b - a))
    return out
