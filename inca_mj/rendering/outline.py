"""The measured robot as an outline: a line round what moves, and thin broken cables.

A sphere of radius r at c is seen as a circle: c + r (cos α, sin α) in the plane of the picture; a
capsule as the convex hull of the circles of its two ends. The outline goes round all of them
together. It covers none of what lies inside, so that both robots are seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np
from PIL import Image, ImageDraw
from scipy.ndimage import morphological_gradient
from scipy.spatial import ConvexHull, QhullError

from inca_mj.rendering.overlay import FINER, Box, Eye, box_of

_CIRCLE = np.linspace(0, 2 * np.pi, 24, endpoint=False)
_SPHERE, _CAPSULE = int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_CAPSULE)
_DASH, _GAP = 7.0, 6.0  # of a broken line [px of 480 rows]


@dataclass(frozen=True)
class Outline:
    """The outline of a robot, in pixels."""

    shapes: tuple[np.ndarray, ...]  # convex polygons, shape (K, 2) each
    cables: tuple[np.ndarray, ...]  # their corners, shape (K, 2) each


def outline_of(
    model: mujoco.MjModel, data: mujoco.MjData, eye: Eye, size: tuple[int, int]
) -> Outline:
    """Returns the outline of a robot that was placed, in a picture of width and height [px].

    Bodies are spheres and capsules; drums, which are cylinders, stay where they are.
    """
    shapes = []
    for i in np.flatnonzero(model.body_weldid[model.geom_bodyid] != 0).tolist():
        if int(model.geom_type[i]) in (_SPHERE, _CAPSULE):
            corners = eye.pixels(_round(model, data, i, eye), size)
            if np.isfinite(corners).all():
                if int(model.geom_type[i]) == _CAPSULE:
                    with suppress(QhullError):  # all in one pixel
                        corners = np.asarray(corners[ConvexHull(corners).vertices])
                shapes.append(corners)
    cables = []
    for k in range(model.ntendon):
        first, count = int(data.ten_wrapadr[k]), int(data.ten_wrapnum[k])
        points = data.wrap_xpos.reshape(-1, 3)[first : first + count]
        corners = eye.pixels(points, size)
        if np.isfinite(corners).all():
            cables.append(corners)
    return Outline(tuple(shapes), tuple(cables))


def draw_outline(picture: np.ndarray, outline: Outline, colour: str, width: float) -> np.ndarray:
    """Returns a picture (height, width, 3) of bytes with the outline over it; width [px]."""
    image = Image.fromarray(picture)
    pen, thick = ImageDraw.Draw(image, "RGBA"), max(1, round(width / 2))
    for corners in outline.cables:
        for dash in _dashes(corners, max(1.0, image.size[1] / 480), image.size):
            pen.line(dash, fill=f"{colour}aa", width=thick)
    room, reach = round(width) + 2, max(1, round(FINER * width / 2))
    for box, inside in _groups(outline.shapes, image.size, room):
        left, top, right, bottom = box
        fine = Image.new("L", (FINER * (right - left), FINER * (bottom - top)))
        pen = ImageDraw.Draw(fine)
        for shape in inside:
            pen.polygon([*map(tuple, (FINER * (shape - (left, top))).tolist())], fill=255)
        edge = morphological_gradient(np.asarray(fine), 2 * reach + 1, mode="nearest")
        image.paste(colour, box, Image.fromarray(edge).reduce(FINER))
    return np.asarray(image)


def _groups(
    shapes: Sequence[np.ndarray], size: tuple[int, int], room: int
) -> list[tuple[Box, list[np.ndarray]]]:
    """Returns groups of shapes whose boxes, widened by `room` pixels, meet; each with its box.

    The marks of the drums stand in all corners of a picture: one box would be all of it.
    """
    groups: list[tuple[Box, list[np.ndarray]]] = []
    for shape in shapes:
        box, inside = box_of(shape, room, size), [shape]
        if box is None:
            continue
        while meeting := [group for group in groups if _meet(group[0], box)]:
            groups = [group for group in groups if not _meet(group[0], box)]
            boxes = [box, *(other for other, _ in meeting)]
            left, top, right, bottom = zip(*boxes, strict=True)
            box = (min(left), min(top), max(right), max(bottom))
            inside += [one for _, shapes_of_it in meeting for one in shapes_of_it]
        groups.append((box, inside))
    return groups


def _meet(one: Box, other: Box) -> bool:
    return (
        one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
    )  # fmt: skip


def _round(model: mujoco.MjModel, data: mujoco.MjData, i: int, eye: Eye) -> np.ndarray:
    """Returns points on the rim of a sphere or a capsule, shape (K, 3) [m]."""
    right, up = eye.axes[:, 0], eye.axes[:, 1]
    radius, half = model.geom_size[i, :2]
    rim = radius * (np.cos(_CIRCLE)[:, None] * right + np.sin(_CIRCLE)[:, None] * up)
    if model.geom_type[i] == _SPHERE:
        return np.asarray(data.geom_xpos[i] + rim)
    axis = half * data.geom_xmat[i].reshape(3, 3)[:, 2]
    return np.vstack([data.geom_xpos[i] + end + rim for end in (axis, -axis)])


def _dashes(corners: np.ndarray, scale: float, size: tuple[int, int]) -> list[list[float]]:
    """Returns the dashes of a line through corners (K, 2) in the picture: x, y, x, y of each."""
    out = []
    for a, b in pairwise(corners):
        length = float(np.linalg.norm(b - a))
        if not length > 0:
            continue
        begins = np.arange(0.0, length, (_DASH + _GAP) * scale)
        ends = np.minimum(begins + _DASH * scale, length)
        parts = a + np.stack([begins, ends], 1)[..., None] / length * (b - a)
        beyond = (parts < -_DASH * scale) | (parts > np.array(size) + _DASH * scale)
        out += parts[~beyond.all(axis=1).any(axis=1)].reshape(-1, 4).tolist()
    return out
