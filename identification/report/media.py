"""Figures, pictures and films inside the one file of a page."""

from __future__ import annotations

from base64 import b64encode
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LARGEST_SVG = 600_000  # characters; a figure of more points is shown as pixels
_LARGEST_VIDEO = 64 * 2**20  # bytes


def drawing(figure: Figure, prefix: str, caption: str) -> Any:
    """An `<svg>` element, or an `<img>` of pixels where that would be too large."""
    import io

    from markupsafe import Markup

    from identification.report.vector import svg

    drawn = svg(figure, prefix, caption)
    if len(drawn) <= _LARGEST_SVG:
        return Markup(drawn)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=150)
    source = "data:image/png;base64," + b64encode(stream.getvalue()).decode()
    said = '<img src="{}" role="img" alt="{}" title="{}" />'
    return Markup(said).format(source, caption, caption)


def image_source(path: Path) -> str:
    """A JPEG as the address of an `<img>`."""
    try:
        return "data:image/jpeg;base64," + b64encode(path.read_bytes()).decode()
    except OSError as error:
        raise InputError(f"cannot read the picture {path}: {error.strerror}") from error


def video_source(path: Path) -> str:
    """An mp4 as the address of a `<video>`."""
    try:
        size = path.stat().st_size
        if size > _LARGEST_VIDEO:
            raise InputError(
                f"{path} has {size / 2**20:.0f} MB, too much for one page; make a shorter film"
            )
        return "data:video/mp4;base64," + b64encode(path.read_bytes()).decode()
    except OSError as error:
        raise InputError(f"cannot read the film {path}: {error.strerror}") from error
