"""A workspace as a translucent body in the frame of the robot, in the style of the film.

Its surface are triangles where the margin is zero. Each cell between eight points of the grid that
are not all inside or all outside gets one vertex, the mean of the points where its edges cross zero
(linear between their ends). Each edge of the grid that crosses zero gets the square of the four
cells around it, as two triangles that look outwards. (Gibson 1998, Constrained elastic surface
nets, without the elastic part.)
"""

from __future__ import annotations

from itertools import product
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image, ImageDraw

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from identification.quantities import quantity
from identification.report.page.style import INK
from identification.storage.files import whole_file
from inca_mj.kinematics.rotations import quaternion
from inca_mj.rendering.legend import tension_scale
from inca_mj.rendering.picture import font_of
from inca_mj.rendering.view import view
from inca_mj.robot.geometry import Geometry
from inca_mj.statics.workspace import NAMES, Workspace
from inca_mj.twin.mjcf import build

CLIP = 0.25  # margins far from the border do not move it: quantile of those inside
COLOUR = [0.0, 0.447, 0.698, 0.33]  # the blue of figures, translucent
_CABLE = 0.008  # radius that cables are drawn with [m]


def workspace_picture(
    found: Workspace,
    path: str | Path,
    parameters: ParameterSet,
    geometry: Geometry,
    *,
    pose: np.ndarray | None = None,
    tension: np.ndarray | None = None,
    camera: str = "front",
    size: tuple[int, int] = (960, 720),
) -> Path:
    """Write a picture of a workspace around the robot as a PNG, whole or not at all.

    Args:
        found: the workspace.
        path: where to write.
        parameters: of the robot.
        geometry: anchors of the cables.
        pose: where the platform is drawn, shape (6,) [m, rad]; at the start when None.
        tension: colours the cables, shape (8,) [N]; grey when None.
        camera: "front" or "side".
        size: width and height [px].

    Returns:
        The path.

    Raises:
        InputError: no point of the grid is inside, the camera is unknown, or the file cannot be
            written.
        GraphicsError: no OpenGL context can be made here.
    """
    vertices, faces = surface(found.axes, found.margin)
    if not len(faces):
        raise InputError(
            f"no point of the grid lies in the {NAMES[found.kind]} workspace, so there is nothing"
            " to draw; give wider limits, or another orientation"
        )
    spec = build(parameters, geometry)
    spec.add_mesh(
        name="workspace",
        uservert=vertices.ravel(),
        userface=faces.ravel(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_MESH, meshname="workspace", rgba=COLOUR, contype=0,
        conaffinity=0, mass=0,
    )  # fmt: skip
    model = spec.compile()
    qpos = model.key("start").qpos.copy()
    if pose is not None:
        qpos[:7] = [*pose[:3], *quaternion(*pose[3:])]
    grey = np.tile([0.35, 0.36, 0.40, 1.0], (model.ntendon, 1))
    colours = grey if tension is None else tension_scale(tension)(tension)
    with view(model, camera, *size, cable=_CABLE) as seen:
        picture = seen.begin(qpos, colours).result()
    image = Image.fromarray(picture)
    _letter(image, found, geometry.assumed)
    path = Path(path)
    with whole_file(path) as draft, draft.open("wb") as stream:
        image.save(stream, format="png")
    return path


def _letter(image: Image.Image, found: Workspace, assumed: bool) -> None:
    em = image.height / 34
    roll, pitch, yaw = found.orientation
    lines = [
        f"{NAMES[found.kind]} workspace: {quantity(found.volume, found.std, 'm³')}",
        f"roll {roll:.2f}, pitch {pitch:.2f}, yaw {yaw:.2f} rad",
        *(["geometry assumed"] if assumed else []),
    ]
    pen = ImageDraw.Draw(image, "RGBA")
    fonts = [font_of(round(em * (0.75 if row else 0.9))) for row in range(len(lines))]
    width = max(pen.textlength(text, font) for text, font in zip(lines, fonts, strict=True))
    card = (em / 2, em / 2, width + 1.5 * em, em * (1.2 + 1.45 * len(lines)))
    pen.rounded_rectangle(card, em / 3, fill=(255, 255, 255, 190))
    for row, (text, font) in enumerate(zip(lines, fonts, strict=True)):
        pen.text((em, em * (1.0 + 1.45 * row)), text, INK, font)


def surface(
    axes: tuple[np.ndarray, np.ndarray, np.ndarray], margin: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices (V, 3) [m] and triangles (F, 3) of the surface where a margin is zero.

    The margin (X, Y, Z) is positive inside; the axes of the grid are evenly spaced [m]. Triangles
    are seen from outside against the clock. Both are empty where no point is inside.
    """
    if not (margin > 0).any():
        return np.empty((0, 3)), np.empty((0, 3), int)
    most = float(np.quantile(margin[margin > 0], CLIP))
    field = np.pad(np.clip(margin, -most, most), 1, constant_values=-most)
    steps = np.array([a[1] - a[0] for a in axes])
    origin = np.array([a[0] for a in axes]) - steps
    inside = field > 0

    corners = list(product((0, 1), repeat=3))
    shape = tuple(n - 1 for n in field.shape)
    total, count = np.zeros((*shape, 3)), np.zeros(shape)
    for a, b in ((p, q) for p in corners for q in corners if sum(q) - sum(p) == 1 and p < q):
        if sum(abs(i - j) for i, j in zip(a, b, strict=True)) != 1:
            continue
        f, g = field[_shifted(a, shape)], field[_shifted(b, shape)]
        crossed = (f > 0) != (g > 0)
        t = np.divide(f, f - g, where=crossed, out=np.zeros_like(f))
        point = np.array(a) + t[..., None] * (np.array(b) - np.array(a))
        total += np.where(crossed[..., None], point, 0.0)
        count += crossed
    cells = np.argwhere(count > 0)
    number = np.full(shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    at = tuple(cells.T)
    vertices = origin + steps * (cells + total[at] / count[at][:, None])

    faces = []
    for axis in range(3):
        first = np.argwhere(np.diff(inside.astype(int), axis=axis) != 0)
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        around = [first - i * u - j * v for i, j in ((1, 1), (0, 1), (0, 0), (1, 0))]
        square = np.stack([number[tuple(cell.T)] for cell in around], axis=1)
        entering = ~inside[tuple(first.T)]  # from outside to inside: looks back
        square[entering] = square[entering][:, ::-1]
        faces += [square[:, [0, 1, 2]], square[:, [0, 2, 3]]]
    return vertices, np.concatenate(faces)


def _shifted(corner: tuple[int, ...], shape: tuple[int, ...]) -> tuple[slice, ...]:
    return tuple(slice(c, c + n) for c, n in zip(corner, shape, strict=True))
