"""Figures, pictures and films inside the one file of a page."""

from __future__ import annotations

from base64 import b64encode
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.files import read_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LARGEST_SVG = 600_000  # characters; a figure of more points is shown as pixels
_LARGEST_VIDEO = 64 * 2**20  # bytes


def drawing(figure: Figure, prefix: str, caption: str) -> Any:
    """Returns an `<svg>` element, or an `<img>` of pixels where that would be too large."""
    import io

    from markupsafe import Markup

    from identification.report.style import write_figure
    from identification.report.vector import svg

    drawn = svg(figure, prefix, caption)
    if len(drawn) <= _LARGEST_SVG:
        return Markup(drawn)
    stream = io.BytesIO()
    write_figure(figure, stream, format="png", dpi=150)
    source = "data:image/png;base64," + b64encode(stream.getvalue()).decode()
    said = '<img src="{}" role="img" alt="{}" title="{}" />'
    return Markup(said).format(source, caption, caption)


def image_source(path: Path) -> str:
    """Returns a JPEG as the address of an `<img>`."""
    return "data:image/jpeg;base64," + b64encode(read_bytes(path, what="picture (.jpg)")).decode()


def video_source(path: Path) -> str:
    """Returns an mp4 as the address of a `<video>`."""
    film = read_bytes(path, _LARGEST_VIDEO, "shorter film (.mp4), which fits into a page")
    return "data:video/mp4;base64," + b64encode(film).decode()
