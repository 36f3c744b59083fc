"""Everything that the frames of a film share: views, plots, letters; of one robot or of two."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.rendering.checks import refuse_magnify, refuse_titles
from inca_mj.rendering.ghost import Difference, common_factor, ghost_difference, ghost_positions
from inca_mj.rendering.legend import TensionScale, tension_scale
from inca_mj.rendering.overlay import between, trace_of
from inca_mj.rendering.picture import BACKGROUND, Box, Lettering, Panel, layout, paste
from inca_mj.rendering.scene import Scene
from inca_mj.rendering.view import View, view

# Radius that cables are drawn with [m]: their own millimetre would be less than a pixel.
_CABLE_FAR, _CABLE_NEAR = 0.008, 0.0018
_THIN = 480  # height of a picture in which the path is one pixel thick


@dataclass(frozen=True, kw_only=True)
class Look:
    """The look of films; a size that is odd or too small is refused."""

    camera: str  # "front", "side" or "handle"
    size: tuple[int, int]  # width and height of the whole frame, even numbers [px]
    # show the motor angles beside the robot; None is yes for one robot, no for two
    plots: bool | None
    titles: Sequence[str]  # a line over each picture; none when empty
    magnify: float  # by how much the deviation from the path that was asked is drawn larger

    def __post_init__(self) -> None:
        width, height = self.size
        if width % 2 or height % 2 or not (160 <= width <= 7680 and 120 <= height <= 4320):
            raise InputError(
                f"a film of {width} x {height} pixels: give even numbers from 160 x 120"
            )
        refuse_magnify(self.magnify)


Begun = Callable[[], np.ndarray]  # waits for a frame, shape (height, width, 3) of bytes


@contextmanager
def stage(scenes: Sequence[Scene], look: Look) -> Iterator[Callable[[float], Begun]]:
    """Yields a function that begins the frame of a time [s], and returns what waits for it.

    All views of a frame are drawn side by side, and the next frame may begin before one is had.
    Pictures of two scenes stand side by side, with one scale of the tensions, and their close views
    draw the difference from the measured robot larger, by one factor. Raises InputError if titles
    or camera do not fit or the frame is too narrow, and GraphicsError without OpenGL.
    """
    refuse_titles(look.titles, len(scenes))
    width, height = look.size
    size = width // len(scenes), height
    if size[0] < 160:
        raise InputError(
            f"a film of {width} pixels for two pictures; give 320 or more, even numbers"
        )
    scale = tension_scale(np.concatenate([s.run.tension for s in scenes]))
    plots = len(scenes) == 1 if look.plots is None else look.plots
    each: list[Difference | None] = []  # from the measured robot; None where none was measured
    for scene in scenes:
        off, robot = None, scene.run.twin
        if scene.angles is not None:
            ghost = ghost_positions(robot, scene.angles, scene.pose)
            off = ghost_difference(robot, scene.run.qpos, ghost, scene.pose is not None)
        each.append(off)
    known = [one for one in each if one is not None]
    times = common_factor(known) if len(known) > 1 else 1.0
    titles = look.titles or [""] * len(scenes)
    with ExitStack() as views:
        stages = [
            views.enter_context(_stage(scene, off, times, size, look, plots, scale, title))
            for scene, off, title in zip(scenes, each, titles, strict=True)
        ]

        def begin(time: float) -> Begun:
            begun = [one(time) for one in stages]
            return lambda: np.hstack([end() for end in begun])

        yield begin


@contextmanager
def _stage(
    shown: Scene, off: Difference | None, times: float, size: tuple[int, int], look: Look,
    plots: bool, scale: TensionScale, title: str,
) -> Iterator[Callable[[float], Begun]]:  # fmt: skip
    """Yields a function that begins the picture of one run at a time [s]; see `stage`."""
    run, trace = shown.run, trace_of(shown.run, look.magnify)
    boxes = layout(size, look.camera, plots, bool(title))
    panel = None
    if boxes.plots is not None:
        panel = Panel(run.time, run.motor_angle, shown.angles, boxes.plots[2:])
    lettering = Lettering(
        size, boxes, scale, ghost=off is not None, assumed=run.twin.geometry.assumed,
        magnify=None if trace is None else trace.magnify, times=times, title=title,
    )  # fmt: skip
    errors = None if off is None else off.errors
    canvas = np.full((size[1], size[0], 3), BACKGROUND, np.uint8)
    views: list[tuple[Box, View, np.ndarray | None]] = []  # with the measured robot as it is seen

    def at(values: np.ndarray | None, time: float) -> np.ndarray | None:
        return None if values is None else between(run.time, values, time)

    def begin(time: float) -> Begun:
        qpos, tension = between(run.time, run.qpos, time), between(run.time, run.tension, time)
        lines = () if trace is None else trace.lines(time, max(1.0, len(canvas) / _THIN))
        drawn = [
            (box, seen.begin(qpos, scale(tension), at(ghost, time), lines))
            for box, seen, ghost in views
        ]
        return lambda: frame(time, drawn)

    def frame(time: float, drawn: Sequence[tuple[Box, Future[np.ndarray]]]) -> np.ndarray:
        out = canvas.copy()
        for box, picture in drawn:
            paste(out, box, picture.result())
        if panel is not None and boxes.plots is not None:
            paste(out, boxes.plots, panel.at(time))
        distance = None if trace is None else trace.distance(time)
        lettering.write(out, time, distance, at(errors, time))
        return out

    with ExitStack() as opened:
        far = _CABLE_NEAR if look.camera == "handle" else _CABLE_FAR
        for box, camera, cable, ghost in (
            (boxes.scene, look.camera, far, None if off is None else off.measured),
            (boxes.handle, "handle", _CABLE_NEAR, None if off is None else off.enlarged(times)),
        ):
            if box is not None:
                seen = opened.enter_context(view(run.twin.model, camera, *box[2:], cable=cable))
                views.append((box, seen, ghost))
        yield begin
