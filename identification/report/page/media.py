"""Figures, pictures and films inside the one file of a page.

A figure is an `<svg>` element that one can zoom and read, in light and in dark. Letters stay
letters, so that they are found, copied and read aloud. Colours of the project's own are CSS
variables with the colour as the default, which a dark page sets anew. What a script must know of
the axes stands in `data-axes` (`templates/figures.js`).
"""

from __future__ import annotations

import io
import json
import re
from base64 import b64encode
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.storage.files import read_bytes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

_LARGEST_SVG = 600_000  # characters; a figure of more points is shown as pixels
_LARGEST_VIDEO = 64 * 2**20  # bytes
POINTS = 72  # of an inch: the unit of a drawing
# What a colour of a figure is on a dark page: of the same hue, and as far from the ground.
DARK = {
    "ffffff": "#15181c", "22262b": "#e4e7eb", "8a9099": "#8a939d", "e4e7eb": "#2b3138",
    "c9ced6": "#3a424b", "0072b2": "#4ea3dc", "d55e00": "#f0803c", "009e73": "#2fc79b",
    "cc79a7": "#dd9cc0", "e69f00": "#f0b63a", "56b4e9": "#8fd0f5", "7a5195": "#b08fd0",
}  # fmt: skip


def drawing(figure: Figure, prefix: str, caption: str) -> Any:
    """Returns an `<svg>` element, or an `<img>` of pixels where that would be too large."""
    from markupsafe import Markup

    from identification.report.page.style import write_figure

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


def svg(figure: Figure, prefix: str = "", title: str = "") -> str:
    """Returns a figure as an `<svg>` element in HTML, without XML header or foreign address.

    Names inside get the prefix, because they are unique in their own figure only; the title is
    read aloud.
    """
    import matplotlib

    from identification.report.page.style import STYLE, write_figure

    flat = [ax for ax in figure.axes if ax.name == "rectilinear" and ax.axison]
    series = [_name_lines(ax, k) for k, ax in enumerate(flat)]
    for k, ax in enumerate(flat):
        ax.set_gid(f"panel{k}")
    stream = io.StringIO()
    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    with matplotlib.rc_context({**STYLE, "svg.fonttype": "none"}):
        write_figure(figure, stream, format="svg", metadata=nothing)
    text = stream.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text[text.index("<svg") :], flags=re.DOTALL)
    text = re.sub(
        rf"#({'|'.join(DARK)})\b", lambda m: f"var(--c-{m[1].lower()}, #{m[1].lower()})", text,
        flags=re.I,
    )  # fmt: skip
    text = re.sub(  # numbers of paths to a hundredth of a point
        r'\bd="([^"]*)"',
        lambda m: re.sub(r"-?\d+\.\d{3,}", lambda n: f"{float(n[0]):.2f}", m[0]),
        text,
    )
    for begin in (r'\bid="', 'href="#', r"url\(#"):
        text = re.sub(begin, lambda m: m[0] + prefix, text)
    axes = [_tell(figure, ax, prefix, s, flat) for ax, s in zip(flat, series, strict=True)]
    name = f"{prefix}title"
    head = f' role="img" aria-labelledby="{name}"'
    if axes:
        head += f' data-axes="{escape(json.dumps(axes, separators=(",", ":")))}"'
    start = text.index(">")
    return f'{text[:start]}{head}><title id="{name}">{escape(title)}</title>{text[start + 1 :]}'


def _name_lines(ax: Axes, k: int) -> list[dict[str, str]]:
    """Names the lines of some axes for a drawing, and returns the names with the labels."""
    import numpy as np

    out = []
    for i, line in enumerate(ax.get_lines()):
        if np.size(line.get_xdata(orig=False)) > 2:
            line.set_gid(f"line{k}.{i}")
            label = str(line.get_label()).replace(r"\$", "$")
            out.append({"id": f"line{k}.{i}", "label": "" if label.startswith("_") else label})
    return out


def _tell(
    figure: Figure, ax: Axes, prefix: str, series: Sequence[dict[str, str]], every: Sequence[Axes]
) -> dict[str, Any]:
    """Returns what the script must know of some axes."""
    width, height = (float(POINTS * size) for size in figure.get_size_inches())
    place = ax.get_position()
    box = [place.x0 * width, (1 - place.y1) * height, place.x1 * width, (1 - place.y0) * height]
    x, y = ax.get_shared_x_axes(), ax.get_shared_y_axes()
    shared = [
        next(k for k, other in enumerate(every) if other is ax or of.joined(ax, other))
        for of in (x, y)
    ]
    return {
        "id": f"{prefix}panel{every.index(ax)}",
        "box": [round(b, 2) for b in box],
        "x": _range(ax.xaxis, ax.get_xlim()),
        "y": _range(ax.yaxis, ax.get_ylim()),
        "sx": shared[0],
        "sy": shared[1],
        "names": [_label(every, x, ax, "xlabel"), _label(every, y, ax, "ylabel")],
        "series": [{**one, "id": prefix + one["id"]} for one in series],
    }


def _range(axis: Axis, ends: tuple[float, float]) -> list[float | str]:
    """Returns first and last value of an axis, and its kind: one with words for ticks is fixed."""
    from matplotlib.ticker import FixedLocator

    kind = axis.get_scale()
    words = isinstance(axis.get_major_locator(), FixedLocator)
    known = kind in ("linear", "log") and not words and ends[0] < ends[1]
    return [float(f"{ends[0]:.8g}"), float(f"{ends[1]:.8g}"), kind if known else "fixed"]


def _label(every: Sequence[Axes], shared: Any, ax: Axes, which: str) -> str:
    """Returns the label of an axis, or of one that shares its values."""
    of = [ax, *(other for other in every if shared.joined(ax, other))]
    said = next((text for one in of if (text := getattr(one, f"get_{which}")())), which[0])
    return str(said).replace("\n", " ").replace(r"\$", "$")
