"""Frames to an mp4 file, by the ffmpeg that imageio-ffmpeg brings along."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np

from identification.errors import InputError


@contextmanager
def encoder(
    path: Path, size: tuple[int, int], fps: float
) -> Iterator[Callable[[np.ndarray | None], None]]:
    """Yields a function that takes frames (height, width, 3); the file is complete after the block.

    Args:
        path: of the mp4 file.
        size: width and height, even numbers [px].
        fps: frames per second.

    Raises:
        InputError: ffmpeg is missing or fails.
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
            raise InputError(
                "ffmpeg cannot write the film; make room for it, or set IMAGEIO_FFMPEG_EXE to a"
                " working ffmpeg"
            ) from error

    with closing(writer):
        send(None)  # starts the program
        yield send
