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

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LARGEST_SVG = 1_500_000  # characters; a figure of more points is shown as pixels
_LARGEST_VIDEO = 64 * 2**20  # bytes
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
        table: shown below the text.
        video: an mp4 file, shown last.
    """

    title: str
    text: str = ""
    figures: tuple[tuple[str, Figure], ...] = ()
    table: Table | None = None
    video: Path | None = None


def write_report(
    path: str | Path,
    title: str,
    verdict: Sequence[str],
    sections: Sequence[Section],
    *,
    good: bool | None = None,
    footer: str = "",
) -> Path:
    """Write a report, whole or not at all.

    Args:
        path: of the HTML file.
        title: its heading.
        verdict: sentences; the reader sees them first.
        sections: in order.
        good: colours the verdict: True passed, False failed, None neither.
        footer: versions, seed, command.

    Raises:
        InputError: a video cannot be read or is too large, or the file cannot be written.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("identification.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    page = environment.get_template("report.html").render(
        title=title,
        verdict=list(verdict),
        sections=[_section(section, number) for number, section in enumerate(sections, 1)],
        mood={True: "good", False: "bad", None: "plain"}[good],
        footer=footer,
    )
    return write_text(path, page)


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
        "video": _video(section.video) if section.video else None,
    }


def _picture(figure: Figure, prefix: str, caption: str) -> Any:
    """An `<svg>` element, or an `<img>` of pixels where that would be too large."""
    import io

    from markupsafe import Markup

    from identification.report.style import svg

    drawing = svg(figure)
    if len(drawing) > _LARGEST_SVG:
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=150)
        source = "data:image/png;base64," + b64encode(stream.getvalue()).decode()
        return Markup('<img src="{}" alt="{}" />').format(source, caption)
    # Names inside a drawing are unique in their own file only; here many share one page.
    drawing = re.sub(r'\bid="', f'id="{prefix}', drawing)
    drawing = re.sub(r'href="#', f'href="#{prefix}', drawing)
    return Markup(re.sub(r"url\(#", f"url(#{prefix}", drawing))


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
        (heading, any(map(_is_number, column)))
        for heading, column in zip(table.columns, cells, strict=True)
    ]


def _is_number(cell: object) -> bool:
    return isinstance(cell, int | float) and not isinstance(cell, bool)


def _text(cell: object) -> str:
    if cell is None:
        return "–"
    return f"{cell:.5g}" if isinstance(cell, float) else str(cell)
