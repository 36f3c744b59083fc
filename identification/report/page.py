"""A report: one HTML file with everything in it, that opens without a network."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.errors import InputError
from identification.files import write_text
from identification.report.origin import origin

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure

_LARGEST_SVG = 600_000  # characters; a figure of more points is shown as pixels
_LARGEST_VIDEO = 64 * 2**20  # bytes
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?")
_UNIT = r"[nµmkM]?(?:kg|rad|Hz|min|[gNmsAVWJh])(?:\^?-?[\d²³]+)?(?:/(?:\([^)]*\)|[\w²³^]+))?"
_QUANTITY = re.compile(  # a number, its std, and a unit such as N m s/rad
    rf"[-+]?\d[\d.]*(?:e[-+]?\d+)?(?: ± [\d.]+(?:e[-+]?\d+)?)?(?: %|(?: {_UNIT}(?![\w/]))+)"
)
_NONE = ("–", "unknown", None)  # in the place of a number
LONG = 12  # rows: a table of more is folded
WIDE = 9.0  # a figure of so many inches has a row of its own


@dataclass(frozen=True)
class Table:
    """A table of text and numbers.

    Attributes:
        columns: headings, with units.
        rows: as many cells each; numbers are set to the right.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[object, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise InputError(
                    f"a table of {len(self.columns)} columns has a row of {len(row)} cells"
                )


@dataclass(frozen=True)
class Section:
    """A part of a report.

    Attributes:
        title: its heading.
        text: paragraphs, parted by empty lines.
        figures: figures by caption.
        table: shown below the text; a long one is folded.
        video: an mp4 file, shown last.
        poster: a picture of the film, shown on paper.
        first: its figures and its film stand above all sections, under the verdict.
    """

    title: str
    text: str = ""
    figures: tuple[tuple[str, Figure], ...] = ()
    table: Table | None = None
    video: Path | None = None
    poster: Path | None = None
    first: bool = False


def write_report(
    path: str | Path,
    title: str,
    verdict: Sequence[str],
    sections: Sequence[Section],
    *,
    good: bool | None = None,
    footer: str = "",
    data: Sequence[str] = (),
) -> Path:
    """Write a report, whole or not at all.

    Args:
        path: of the HTML file.
        title: its heading.
        verdict: sentences; the reader sees them first.
        sections: in order.
        good: colours the verdict: True passed, False failed, None neither.
        footer: what is said at its foot, before version, command and date.
        data: names of the logs that it rests on.

    Raises:
        InputError: a video cannot be read or is too large, or the file cannot be written.
    """
    from importlib.resources import files

    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    from identification.report.vector import DARK

    environment = Environment(
        loader=PackageLoader("identification.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["whole"] = whole_quantities
    page = environment.get_template("report.html").render(
        title=title,
        file=Path(path).name,
        verdict=list(verdict),
        sections=[_section(section, number) for number, section in enumerate(sections, 1)],
        mood={True: "good", False: "bad", None: "plain"}[good],
        footer="\n".join(filter(None, [footer, origin(data)])),
        dark=DARK,
        script=Markup((files("identification.report") / "templates" / "figures.js").read_text()),
    )
    return write_text(path, page)


def whole_quantities(text: str) -> Markup:
    """Text for a page in which no line ends between a number and its unit.

    Args:
        text: as it is read; it is escaped.
    """
    from markupsafe import Markup, escape

    return Markup(_QUANTITY.sub(r'<span class="whole">\g<0></span>', str(escape(text))))


def save_figures(sections: Iterable[Section], folder: Path) -> list[Path]:
    """Write the figures of some sections as PNG, named by their captions."""
    from identification.report.style import save_png

    return [
        save_png(figure, folder / f"{re.sub('[^a-z0-9]+', '-', caption.lower()).strip('-')}.png")
        for section in sections
        for caption, figure in section.figures
    ]


def _section(section: Section, number: int) -> dict[str, Any]:
    table = section.table
    return {
        "title": section.title,
        "name": f"part-{number}",
        "first": section.first,
        "paragraphs": [part.strip() for part in section.text.split("\n\n") if part.strip()],
        "figures": [
            (
                caption,
                _picture(figure, f"f{number}_{k}_", caption),
                figure.get_size_inches()[0] >= WIDE,
            )
            for k, (caption, figure) in enumerate(section.figures, 1)
        ],
        "columns": _columns(table) if table else [],
        "rows": [[_text(cell) for cell in row] for row in table.rows] if table else [],
        "folded": table is not None and len(table.rows) > LONG,
        "video": _video(section.video) if section.video else None,
        "poster": _image(section.poster) if section.poster else None,
    }


def _picture(figure: Figure, prefix: str, caption: str) -> Any:
    """An `<svg>` element, or an `<img>` of pixels where that would be too large."""
    import io

    from markupsafe import Markup

    from identification.report.vector import svg

    drawing = svg(figure, prefix, caption)
    if len(drawing) <= _LARGEST_SVG:
        return Markup(drawing)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=150)
    source = "data:image/png;base64," + b64encode(stream.getvalue()).decode()
    said = '<img src="{}" role="img" alt="{}" title="{}" />'
    return Markup(said).format(source, caption, caption)


def _image(path: Path) -> str:
    try:
        return "data:image/jpeg;base64," + b64encode(path.read_bytes()).decode()
    except OSError as error:
        raise InputError(f"cannot read the picture {path}: {error.strerror}") from error


def _video(path: Path) -> str:
    try:
        size = path.stat().st_size
        if size > _LARGEST_VIDEO:
            raise InputError(
                f"{path} has {size / 2**20:.0f} MB, too much for one page; make a shorter film"
            )
        return "data:video/mp4;base64," + b64encode(path.read_bytes()).decode()
    except OSError as error:
        raise InputError(f"cannot read the film {path}: {error.strerror}") from error


def _columns(table: Table) -> list[tuple[str, bool]]:
    """Headings, and whether numbers stand below them."""
    cells = zip(*table.rows, strict=True) if table.rows else ((),) * len(table.columns)
    return [
        (heading, _holds_numbers(column))
        for heading, column in zip(table.columns, cells, strict=True)
    ]


def _holds_numbers(column: Iterable[object]) -> bool:
    """Whether some of the cells are numbers, or all of them are written numbers."""
    cells = list(column)
    written = [isinstance(c, str) and bool(_NUMBER.fullmatch(c)) for c in cells]
    numbers = [isinstance(c, int | float) and not isinstance(c, bool) for c in cells]
    return any(numbers) or (
        any(written) and all(w or c in _NONE for w, c in zip(written, cells, strict=True))
    )


def _text(cell: object) -> str:
    if cell is None:
        return "–"
    return f"{cell:z.5g}" if isinstance(cell, float) else str(cell)
