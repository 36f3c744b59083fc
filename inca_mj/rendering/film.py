"""A film of a run: the simulated robot in full colour, the measured one as a ghost over it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.files import whole_file
from identification.progress import counted
from inca_mj.rendering.colours import TensionScale, tension_scale
from inca_mj.rendering.encoder import encoder
from inca_mj.rendering.ghost import ghost_positions
from inca_mj.rendering.panel import Panel
from inca_mj.rendering.picture import BACKGROUND, Layout, Lettering, layout, paste
from inca_mj.rendering.scene import Scene, Source, make_scene
from inca_mj.rendering.view import View, view
from inca_mj.twin.run import Run

Progress = Callable[[int, int], None]  # frames done, frames in all

MOST_FRAMES = 108_000  # an hour of film at 30 frames a second
# Radius that cables are drawn with [m]: their own millimetre would be less than a pixel.
_CABLE_FAR, _CABLE_NEAR = 0.008, 0.0018


def film(
    source: Source,
    path: str | Path,
    *,
    seconds: float | None = None,
    camera: str = "front",
    size: tuple[int, int] = (1280, 720),
    fps: float = 30,
    plots: bool = True,
    speed: float = 1.0,
    progress: Progress | None = None,
) -> Path:
    """Write a log or a run as an mp4 film, whole or not at all.

    Args:
        source: a log, which is laid over the twin's prediction of it; a comparison, a run, or a
            `Scene` made of one by hand; or the path of a log or of a saved run.
        path: where to write; the name ends in .mp4.
        seconds: only so many from the start [s]; all of it when None.
        camera: "front", "side" or "handle".
        size: width and height of the film, even numbers [px].
        fps: frames per second of the film.
        plots: show the motor angles beside the robot.
        speed: seconds of the run in a second of film; 0.25 is slow motion.
        progress: told the frames done and the frames in all.

    Returns:
        The path.

    Raises:
        InputError: an argument makes no sense, or a file cannot be read or written.
        DivergenceError: the twin cannot be simulated under a log's currents.
        GraphicsError: no OpenGL context can be made here.
    """
    path = Path(path)
    if path.suffix.lower() != ".mp4":
        raise InputError(f"a film is written as .mp4, not {path.name!r}; change its ending")
    if not (np.isfinite([fps, speed]).all() and fps > 0 and speed > 0):
        raise InputError(f"fps {fps:g} and speed {speed:g} must be positive")
    scene = make_scene(source, seconds)
    run = scene.run
    duration = run.time[-1] - run.time[0]
    count = duration * fps / speed + 1
    if count > MOST_FRAMES:
        raise InputError(
            f"{duration:g} s at speed {speed:g} and {fps:g} frames a second are {count:.3g} frames,"
            f" more than {MOST_FRAMES}; film fewer seconds, or at a higher speed"
        )
    # The small part of a frame keeps the last one when the division is not exact.
    times = run.time[0] + np.arange(int(duration * fps / speed + 1e-6) + 1) * speed / fps
    with (
        _stage(scene, camera, size, plots) as stage,
        whole_file(path) as draft,
        encoder(draft, size, fps) as send,
    ):
        for done, time in enumerate(counted(times, "frames", len(times)), 1):
            send(stage.frame(time))
            if progress is not None:
                progress(done, len(times))
    return path


def stills(
    source: Source,
    folder: str | Path,
    times: Sequence[float],
    *,
    camera: str = "front",
    size: tuple[int, int] = (1280, 720),
    plots: bool = True,
) -> list[Path]:
    """Write frames of the film at some times as PNG files.

    Args:
        source: as of `film`.
        folder: where to write.
        times: of the pictures [s].
        camera: "front", "side" or "handle".
        size: width and height of a picture, even numbers [px].
        plots: show the motor angles beside the robot.

    Returns:
        The files, `<camera>_<time>s.png`, in the order of the times.

    Raises:
        InputError: an argument makes no sense, or a file cannot be read or written.
        DivergenceError: the twin cannot be simulated under a log's currents.
        GraphicsError: no OpenGL context can be made here.
    """
    from PIL import Image

    scene = make_scene(source)
    run, paths = scene.run, []
    with _stage(scene, camera, size, plots) as stage:
        for time in times:
            if not run.time[0] <= time <= run.time[-1]:
                raise InputError(
                    f"no picture at {time:g} s: the run is of [{run.time[0]:g}, {run.time[-1]:g}] s"
                )
            paths.append(Path(folder) / f"{camera}_{time:.2f}s.png")
            with whole_file(paths[-1]) as draft:
                Image.fromarray(stage.frame(time)).save(draft)
    return paths


@dataclass(frozen=True, kw_only=True)
class _Stage:
    """Everything that frames of one run share."""

    run: Run
    ghost: np.ndarray | None
    scale: TensionScale
    boxes: Layout
    scene: View
    handle: View | None
    panel: Panel | None
    lettering: Lettering
    canvas: np.ndarray

    def frame(self, time: float) -> np.ndarray:
        """The picture at a time [s], shape (height, width, 3) of bytes."""
        run, frame = self.run, self.canvas.copy()
        qpos = _between(run.time, run.qpos, time)
        ghost = None if self.ghost is None else _between(run.time, self.ghost, time)
        colours = self.scale(_between(run.time, run.tension, time))
        paste(frame, self.boxes.scene, self.scene.draw(qpos, colours, ghost))
        if self.handle is not None and self.boxes.handle is not None:
            paste(frame, self.boxes.handle, self.handle.draw(qpos, colours, ghost))
        if self.panel is not None and self.boxes.plots is not None:
            paste(frame, self.boxes.plots, self.panel.at(time))
        self.lettering.write(frame, time)
        return frame


@contextmanager
def _stage(shown: Scene, camera: str, size: tuple[int, int], plots: bool) -> Iterator[_Stage]:
    width, height = size
    if width % 2 or height % 2 or not (160 <= width <= 7680 and 120 <= height <= 4320):
        raise InputError(f"a film of {width} x {height} pixels: give even numbers from 160 x 120")
    run, measured = shown.run, shown.angles
    ghost = None if measured is None else ghost_positions(run.twin, measured, shown.pose)
    boxes, scale = layout(size, camera, plots), tension_scale(run.tension)
    panel = None
    if boxes.plots is not None:
        panel = Panel(run.time, run.motor_angle, measured, boxes.plots[2:])
    assumed = run.twin.geometry.assumed
    with ExitStack() as open_views:
        model = run.twin.model
        near = _CABLE_NEAR if camera == "handle" else _CABLE_FAR
        scene = open_views.enter_context(view(model, camera, *boxes.scene[2:], cable=near))
        handle = None
        if boxes.handle is not None:
            handle = open_views.enter_context(
                view(model, "handle", *boxes.handle[2:], cable=_CABLE_NEAR)
            )
        yield _Stage(
            run=run,
            ghost=ghost,
            scale=scale,
            boxes=boxes,
            scene=scene,
            handle=handle,
            panel=panel,
            lettering=Lettering(size, boxes, scale, ghost is not None, assumed),
            canvas=np.full((height, width, 3), BACKGROUND, np.uint8),
        )


def _between(time: np.ndarray, values: np.ndarray, at: float) -> np.ndarray:
    """Values (N, m) at a time between samples, on a straight line; drawing norms quaternions."""
    k = int(np.clip(np.searchsorted(time, at, "right") - 1, 0, len(time) - 2))
    part = (at - time[k]) / (time[k + 1] - time[k])
    first, last = values[k], values[k + 1].copy()
    if values.shape[1] == 15 and first[3:7] @ last[3:7] < 0:
        last[3:7] *= -1  # the same rotation, the short way round
    return (1 - part) * first + part * last
