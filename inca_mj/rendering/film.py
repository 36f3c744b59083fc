"""A film of a run: the simulated robot in full colour, the measured one as an outline over it.

Two runs are filmed side by side, at the same times. If both have a measured robot, the close view
enlarges how far it is from the simulated one (`inca_mj.rendering.ghost`). Frames become an mp4 file
by the ffmpeg that imageio-ffmpeg brings along.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.runtime.progress import counted
from identification.storage.files import whole_file
from inca_mj.rendering.checks import refuse_speed
from inca_mj.rendering.overlay import MAGNIFY
from inca_mj.rendering.scene import Scene, Source, make_scene
from inca_mj.rendering.stage import Begun, Look, stage

Progress = Callable[[int, int], None]  # frames done, frames in all
# Views of a frame take unlike times: with two frames waiting, the quicker view has work as well.
AHEAD = 2
MOST_FRAMES = 108_000  # an hour of film at 30 frames a second
FAILED = (
    "ffmpeg cannot write the film; make room for it, or set IMAGEIO_FFMPEG_EXE to a working ffmpeg"
)


def film(
    source: Source,
    path: str | Path,
    *,
    beside: Source | None = None,
    titles: Sequence[str] = (),
    seconds: float | None = None,
    camera: str = "front",
    size: tuple[int, int] = (1280, 720),
    fps: float = 30,
    plots: bool | None = None,
    speed: float = 1.0,
    magnify: float = MAGNIFY,
    picture: str | Path | None = None,
    progress: Progress | None = None,
) -> Path:
    """Write a log or a run as an mp4 film, whole or not at all.

    Args:
        source: a log, which is laid over the twin's prediction of it; a comparison, a run, or a
            `Scene` made of one by hand; or the path of a log or of a saved run.
        path: where to write; the name ends in .mp4.
        beside: another one, filmed beside the first over the time that both have.
        titles: a line over each picture; none when empty.
        seconds: only so many from the start [s]; all of it when None.
        camera: "front", "side" or "handle".
        size: width and height of the film, even numbers [px]; two pictures have half the width
            each.
        fps: frames per second of the film.
        plots: show the motor angles beside the robot; None is yes for one robot, no for two.
        speed: seconds of the run in a second of film; 0.25 is slow motion.
        magnify: by how much the deviation from a path that was asked is drawn larger.
        picture: a .jpg file to which the frame in the middle is written; none when None.
        progress: told the frames done and the frames in all.

    Returns:
        The path.

    Raises:
        InputError: an argument makes no sense, a file cannot be read or written, or two runs have
            no common time.
        DivergenceError: the twin cannot be simulated under a log's currents.
        GraphicsError: no OpenGL context can be made here.
    """
    from PIL import Image

    path = Path(path)
    if path.suffix.lower() != ".mp4":
        raise InputError(f"a film is written as .mp4, not {path.name!r}; change its ending")
    refuse_speed(fps, speed)
    look = Look(camera=camera, size=size, plots=plots, titles=titles, magnify=magnify)
    scenes = _scenes(source, beside, seconds)
    begin, end = common_time(scenes)
    count = (end - begin) * fps / speed + 1
    if count > MOST_FRAMES:
        raise InputError(
            f"{end - begin:g} s at speed {speed:g} and {fps:g} frames a second are {count:.3g}"
            f" frames, more than {MOST_FRAMES}; film fewer seconds, or at a higher speed"
        )
    # The small part of a frame keeps the last one when the division is not exact.
    times = begin + np.arange(int((end - begin) * fps / speed + 1e-6) + 1) * speed / fps
    with (
        stage(scenes, look) as begin_frame,
        whole_file(path) as draft,
        encoder(draft, size, fps) as send,
    ):
        frames = counted(_in_turn(begin_frame, times), "frames", len(times))
        for done, drawn in enumerate(frames, 1):
            send(drawn)
            if picture is not None and done == (len(times) + 1) // 2:
                with whole_file(picture) as other:
                    Image.fromarray(drawn).save(other, format="jpeg", quality=85)
            if progress is not None:
                progress(done, len(times))
    return path


def stills(
    source: Source,
    folder: str | Path,
    times: Sequence[float],
    *,
    beside: Source | None = None,
    titles: Sequence[str] = (),
    camera: str = "front",
    size: tuple[int, int] = (1280, 720),
    plots: bool | None = None,
    magnify: float = MAGNIFY,
) -> list[Path]:
    """Write frames of the film at some times as PNG files.

    Args:
        source: as of `film`.
        folder: where to write.
        times: of the pictures [s].
        beside: another one, as of `film`.
        titles: a line over each picture; none when empty.
        camera: "front", "side" or "handle".
        size: width and height of a frame, even numbers [px].
        plots: show the motor angles beside the robot; None is yes for one robot, no for two.
        magnify: by how much the deviation from a path that was asked is drawn larger.

    Returns:
        The files, `<camera>_<time>s.png`, in the order of the times.

    Raises:
        InputError: an argument makes no sense, a file cannot be read or written, or two runs have
            no common time.
        DivergenceError: the twin cannot be simulated under a log's currents.
        GraphicsError: no OpenGL context can be made here.
    """
    from PIL import Image

    look = Look(camera=camera, size=size, plots=plots, titles=titles, magnify=magnify)
    scenes, paths = _scenes(source, beside, None), []
    begin, end = common_time(scenes)
    with stage(scenes, look) as begin_frame:
        for time in times:
            if not begin <= time <= end:
                raise InputError(f"no picture at {time:g} s: the run is of [{begin:g}, {end:g}] s")
            paths.append(Path(folder) / f"{camera}_{time:.2f}s.png")
            with whole_file(paths[-1]) as draft:
                Image.fromarray(begin_frame(time)()).save(draft)
    return paths


def common_time(scenes: Sequence[Scene]) -> tuple[float, float]:
    """Returns begin and end of the time that all scenes have [s]; refuses scenes that have none."""
    spans = [(float(s.run.time[0]), float(s.run.time[-1])) for s in scenes]
    begin, end = max(a for a, _ in spans), min(b for _, b in spans)
    if not begin < end:
        text = " and ".join(f"[{a:g}, {b:g}] s" for a, b in spans)
        raise InputError(
            f"the runs have no common time: they are of {text}; give runs of the same time"
        )
    return begin, end


def _scenes(source: Source, beside: Source | None, seconds: float | None) -> list[Scene]:
    return [make_scene(one, seconds) for one in (source, beside) if one is not None]


def _in_turn(begin: Callable[[float], Begun], times: Iterable[float]) -> Iterator[np.ndarray]:
    """Yields the frames of some times in turn; the next ones are drawn while one is written."""
    waiting: deque[Begun] = deque()
    for time in times:
        waiting.append(begin(time))
        if len(waiting) > AHEAD:
            yield waiting.popleft()()
    while waiting:
        yield waiting.popleft()()


@contextmanager
def encoder(
    path: Path, size: tuple[int, int], fps: float
) -> Iterator[Callable[[np.ndarray | None], None]]:
    """Yields a function that takes frames (height, width, 3); the mp4 is complete after the block.

    `size` is width and height, even numbers [px]. Raises InputError if ffmpeg is missing or fails.
    """
    import imageio_ffmpeg

    # It warns of a film without frames, which an interrupt leaves; its errors are raised too.
    logging.getLogger("imageio_ffmpeg").setLevel(logging.CRITICAL)
    writer = imageio_ffmpeg.write_frames(
        str(path), size, fps=fps, codec="libx264", quality=None, macro_block_size=2,
        ffmpeg_log_level="quiet",  # it would write beside what this program says
        output_params=["-crf", "26", "-preset", "veryfast", "-movflags", "+faststart"],
    )  # fmt: skip

    def send(frame: np.ndarray | None) -> None:
        try:
            writer.send(frame)
        except (OSError, RuntimeError) as error:  # it died, its disk is full, or there is none
            raise InputError(FAILED) from error

    with closing(writer):
        send(None)  # starts the program
        yield send
    # What fails behind the last frame, such as a disk that is full then, ffmpeg tells nobody.
    if not _is_whole(path):
        raise InputError(FAILED)


def _is_whole(path: Path) -> bool:
    """Returns whether a film has its index, and each of its parts to its end."""
    with path.open("rb") as file:
        size, at, kinds = path.stat().st_size, 0, set()
        while at + 8 <= size:
            file.seek(at)
            length, kind = int.from_bytes(file.read(4), "big"), file.read(4)
            if length < 8:  # of a part that was never ended
                return False
            kinds.add(kind)
            at += length
    return at == size and b"moov" in kinds
