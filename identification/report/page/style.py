"""The look of figures: colours that stay apart for the colour-blind (Okabe and Ito), and files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import IO, Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from identification.storage.files import whole_file

SIMULATED = "#D55E00"  # vermilion
MEASURED = "#0072B2"  # blue
INK, GREY = "#22262B", "#8A9099"
SERIES = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A5195", "#22262B",
)  # fmt: skip

STYLE: Any = {
    "font.size": 9,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.titlesize": 9.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E4E7EB",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "svg.hashsalt": "identification",  # the same figure gives the same bytes
}

styled = matplotlib.rc_context(STYLE)  # decorates a function that draws


def time_panels(figure: Figure, count: int, **how: Any) -> list[Axes]:
    """Returns axes for so many panels over time, in up to two columns, the first one filled."""
    axes = figure.subplots(-(-count // 2), min(2, count), sharex=True, squeeze=False, **how)
    for ax in axes[-1]:
        ax.set_xlabel("time [s]")
    panels = [*axes.T.ravel()]
    for ax in panels[count:]:
        ax.set_axis_off()
    return panels[:count]


def literal(text: str) -> str:
    """Returns a name as a figure shows it, letter by letter: `$` would begin a formula."""
    return text.replace("$", r"\$")


def settle(figure: Figure) -> None:
    """Place the parts of a figure for good: anew for each file it takes as long as drawing."""
    engine = figure.get_layout_engine()
    if engine is not None:
        with matplotlib.rc_context(STYLE):  # ticks are made when they are asked for
            engine.execute(figure)
        figure.set_layout_engine(None)


def write_figure(figure: Figure, stream: IO[Any], **how: Any) -> None:
    """Write a figure to a stream, also one with letters that the font of its pixels lacks.

    A joint may be called by any letter. Where there is no picture of it, a box stands, and a
    browser shows the letter itself; matplotlib would warn of each one.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", r"Glyph .* missing from", UserWarning)
        figure.savefig(stream, **how)


def save_png(figure: Figure, path: str | Path, dpi: float = 150) -> Path:
    """Write a figure as PNG, whole or not at all.

    Args:
        figure: of matplotlib, such as that of `windows_figure`.
        path: where to write.
        dpi: pixels per inch.

    Returns:
        The path.

    Raises:
        InputError: the file cannot be written.
    """
    with whole_file(path) as draft, draft.open("wb") as stream:
        write_figure(figure, stream, format="png", dpi=dpi)
    return Path(path)
