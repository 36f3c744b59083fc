"""A workspace as a translucent body in the frame of the robot, in the style of the film."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from identification.quantities import quantity
from identification.report.style import INK
from identification.writing import whole_file
from inca_mj.kinematics.rotations import quaternion
from inca_mj.rendering.colours import tension_scale
from inca_mj.rendering.view import view
from inca_mj.robot.geometry import Geometry
from inca_mj.statics.surface import surface
from inca_mj.statics.workspace import Workspace
from inca_mj.twin.mjcf import build

COLOUR = [0.0, 0.447, 0.698, 0.33]  # the blue of figures, translucent
_CABLE = 0.008  # radius that cables are drawn with [m]
NAMES = {"closure": "wrench-closure", "feasible": "wrench-feasible", "static": "static"}


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
        picture = seen.draw(qpos, colours, None)
    image = Image.fromarray(picture)
    _letter(image, found, geometry.assumed)
    path = Path(path)
    with whole_file(path) as draft, draft.open("wb") as stream:
        image.save(stream, format="png")
    return path


def _letter(image: Image.Image, found: Workspace, assumed: bool) -> None:
    import matplotlib

    em = image.height / 34
    file = Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")
    roll, pitch, yaw = found.orientation
    lines = [
        f"{NAMES[found.kind]} workspace: {quantity(found.volume, found.std, 'm³')}",
        f"roll {roll:.2f}, pitch {pitch:.2f}, yaw {yaw:.2f} rad",
        *(["geometry assumed"] if assumed else []),
    ]
    pen = ImageDraw.Draw(image, "RGBA")
    fonts = [
        ImageFont.truetype(file, round(em * (0.75 if row else 0.9))) for row in range(len(lines))
    ]
    width = max(pen.textlength(text, font) for text, font in zip(lines, fonts, strict=True))
    card = (em / 2, em / 2, width + 1.5 * em, em * (1.2 + 1.45 * len(lines)))
    pen.rounded_rectangle(card, em / 3, fill=(255, 255, 255, 190))
    for row, (text, font) in enumerate(zip(lines, fonts, strict=True)):
        pen.text((em, em * (1.0 + 1.45 * row)), text, INK, font)
