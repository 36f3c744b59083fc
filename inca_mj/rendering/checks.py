"""Checks of what a film may be asked for, made before anything is simulated or drawn."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from identification.errors import InputError


def refuse_seconds(seconds: float | None) -> None:
    """Refuses a length of a film that is not above zero; None is all of a run."""
    if seconds is not None and not seconds > 0:
        raise InputError(f"cannot film {seconds:g} s; give a positive number of seconds")


def refuse_speed(fps: float, speed: float) -> None:
    """Refuses frames per second, or seconds of the run in one of film, that are not positive."""
    if not (isfinite(fps) and isfinite(speed) and fps > 0 and speed > 0):
        raise InputError(f"fps {fps:g} and speed {speed:g} must be positive")


def refuse_magnify(magnify: float) -> None:
    """Refuses a magnification of deviations that is not positive and finite."""
    if not (isfinite(magnify) and magnify > 0):
        raise InputError(f"a deviation drawn {magnify:g} times: give a positive number")


def refuse_titles(titles: Sequence[str], pictures: int) -> None:
    """Refuses titles that are not one for each picture, or none."""
    if titles and len(titles) != pictures:
        raise InputError(
            f"{len(titles)} titles for {pictures} pictures; give one for each, or none"
        )
