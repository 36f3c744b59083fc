"""Checks of what a film may be asked for, made before anything is simulated or drawn."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from identification.errors import InputError


def refuse_seconds(seconds: float | None) -> None:
    """Refuse a length that is no time.

    Args:
        seconds: from the start of a run [s]; None for all of it.

    Raises:
        InputError: it is not above zero.
    """
    if seconds is not None and not seconds > 0:
        raise InputError(f"cannot film {seconds:g} s; give a positive number of seconds")


def refuse_speed(fps: float, speed: float) -> None:
    """Refuse a rate of frames or a speed that no film has.

    Args:
        fps: frames per second.
        speed: seconds of the run in a second of film.

    Raises:
        InputError: one of them is not positive and finite.
    """
    if not (isfinite(fps) and isfinite(speed) and fps > 0 and speed > 0):
        raise InputError(f"fps {fps:g} and speed {speed:g} must be positive")


def refuse_magnify(magnify: float) -> None:
    """Refuse a magnification that draws nothing.

    Args:
        magnify: by how much a deviation is drawn larger.

    Raises:
        InputError: it is not positive and finite.
    """
    if not (isfinite(magnify) and magnify > 0):
        raise InputError(f"a deviation drawn {magnify:g} times: give a positive number")


def refuse_titles(titles: Sequence[str], pictures: int) -> None:
    """Refuse titles that do not go with the pictures.

    Args:
        titles: a line over each picture; none when empty.
        pictures: how many stand side by side.

    Raises:
        InputError: there are other numbers of titles and pictures.
    """
    if titles and len(titles) != pictures:
        raise InputError(
            f"{len(titles)} titles for {pictures} pictures; give one for each, or none"
        )
