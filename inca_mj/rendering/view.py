"""One camera's picture of the robot, with the measured one as an outline over it.

Views of one frame are drawn side by side. A context of OpenGL belongs to the thread that made it,
so a view has a thread of its own, in which its renderer is made, draws and is freed.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, Future
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from math import atan, degrees, radians, tan

import mujoco
import numpy as np

from identification.errors import unknown_name
from identification.report.page.style import MEASURED
from inca_mj.rendering.graphics import drawing_thread, renderer
from inca_mj.rendering.outline import draw_outline, outline_of
from inca_mj.rendering.overlay import Eye, Line, overlay

CAMERAS = ("front", "side", "handle")

_EDGE = 1 / 480  # of the height: the line round the measured robot
_SAMPLES = 4  # antialiasing; software OpenGL knows 0 and 4, and 0 breaks cables into dots
# Of all round parts in a view of the whole robot, where they have few pixels: it is drawn faster.
_SLICES, _STACKS, _FEW_ROWS = 16, 8, 720
_WIDE = 1.15  # width to height that a camera is made for


@dataclass(frozen=True)
class View:
    """A renderer with a model of its own, whose cables it may colour and thicken."""

    camera: str  # its name in the model
    model: mujoco.MjModel  # with the cables as they are drawn
    robot: mujoco.MjData  # the simulated robot, as it was drawn last
    ghost: mujoco.MjData  # the measured one
    draws: mujoco.Renderer  # the renderer, which only `thread` may use
    thread: Executor  # draws one picture after the other

    def begin(
        self, qpos: np.ndarray, colours: np.ndarray, ghost: np.ndarray | None = None,
        lines: Sequence[Line] = (),
    ) -> Future[np.ndarray]:  # fmt: skip
        """Begins a picture of positions (15,) with colours of the cables (8, 4) in [0..1].

        The result waits for the picture, shape (height, width, 3) of bytes. The measured robot,
        positions (15,), is drawn as an outline. Lines are drawn over the picture, so that the
        platform does not hide where it should be.
        """
        return self.thread.submit(self._draw, qpos, colours, ghost, lines)

    def _draw(
        self, qpos: np.ndarray, colours: np.ndarray, ghost: np.ndarray | None, lines: Sequence[Line]
    ) -> np.ndarray:
        self.model.tendon_rgba[:] = colours
        _place(self.model, self.robot, qpos)
        self.draws.update_scene(self.robot, self.camera)
        scene = self.draws.scene
        # On a CPU each of these costs several times the rest of the picture.
        scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
        scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        scene.flags[mujoco.mjtRndFlag.mjRND_HAZE] = True
        picture, eye = self.draws.render(), self.eye()
        if lines:
            picture = overlay(picture, lines, eye)
        if ghost is None:
            return picture
        _place(self.model, self.ghost, ghost)
        size = (picture.shape[1], picture.shape[0])
        outline = outline_of(self.model, self.ghost, eye, size)
        return draw_outline(picture, outline, MEASURED, max(1.0, _EDGE * size[1]))

    def eye(self) -> Eye:
        """Returns the camera for the state that was drawn last."""
        number = self.model.camera(self.camera).id
        return Eye(
            self.robot.cam_xpos[number].copy(),
            self.robot.cam_xmat[number].reshape(3, 3).copy(),
            radians(self.model.cam_fovy[number]),
        )


@contextmanager
def view(
    model: mujoco.MjModel, camera: str, width: int, height: int, *, cable: float
) -> Iterator[View]:
    """Opens a view of width x height pixels; `cable` is the radius cables are drawn with [m]."""
    if camera not in CAMERAS:
        raise unknown_name("camera", camera, CAMERAS)
    copied = copy.copy(model)
    copied.vis.global_.offwidth, copied.vis.global_.offheight = width, height
    copied.vis.quality.offsamples = _SAMPLES
    copied.tendon_width[:] = cable
    if camera != "handle" and height <= _FEW_ROWS:
        copied.vis.quality.numslices, copied.vis.quality.numstacks = _SLICES, _STACKS
    number = copied.camera(camera).id
    narrow = max(1.0, _WIDE * height / width)
    copied.cam_fovy[number] = 2 * degrees(atan(narrow * tan(radians(copied.cam_fovy[number]) / 2)))
    with drawing_thread() as thread, ExitStack() as opened:
        made = ExitStack()
        opened.callback(lambda: thread.submit(made.close).result())
        draws = thread.submit(made.enter_context, renderer(copied, width, height)).result()
        yield View(camera, copied, mujoco.MjData(copied), mujoco.MjData(copied), draws, thread)


def _place(model: mujoco.MjModel, data: mujoco.MjData, qpos: np.ndarray) -> None:
    """Computes what drawing needs of a state: positions of bodies, lights, cameras and tendons."""
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_camlight(model, data)
    mujoco.mj_tendon(model, data)
