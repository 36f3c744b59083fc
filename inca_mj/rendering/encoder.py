"""Frames to an mp4 file, by the ffmpeg that imageio-ffmpeg brings along."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np

from identification.errors import InputError

FAILED = (
    "ffmpeg cannot write the film; make room for it, or set IMAGEIO_FFMPEG_EXE to a working ffmpeg"
)


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
