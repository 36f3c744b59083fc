"""A report: one HTML file with everything in it, that opens without a network."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.errors import InputError
from identification.files import read_text, write_text
from identification.report.cells import columns_of, text_of
from identification.report.media import drawing, image_source, video_source
from identification.report.origin import origin
from identification.report.whole_quantities import whole_quantities

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TEMPLATES = Path(__file__).parent / "templates"
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

    @property
    def last_first(self) -> Table:
        """The table with the last column behind the first, so that both fit a narrow screen."""
        (name, *middle, last) = self.columns
        rows = tuple((first, end, *rest) for first, *rest, end in self.rows)
        return Table((name, last, *middle), rows)

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
    drawings: dict[Figure, str] | None = None,
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
        drawings: elements that an earlier page drew of the same figures; the others are added.

    Raises:
        InputError: a video cannot be read or is too large, or the file cannot be written.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    from identification.report.vector import DARK

    script = f"\n//<![CDATA[\n{read_text(TEMPLATES / 'figures.js')}\n//]]>\n"
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
        sections=[
            _section(section, number, {} if drawings is None else drawings)
            for number, section in enumerate(sections, 1)
        ],
        mood={True: "good", False: "bad", None: "plain"}[good],
        footer="\n".join(filter(None, [footer, origin(data)])),
        dark=DARK,
        script=Markup(script),
        policy=_policy(script),
    )
    return write_text(path, page)


def _policy(script: str) -> str:
    """Returns what a browser may do for a page: nothing but show what stands in it.

    No word of a log or a model can then run a script, or ask another computer for anything. Styles
    may stand anywhere, because figures have some in their elements.

    Args:
        script: all that stands in the element of the page's one script.
    """
    digest = b64encode(sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline';"
        " img-src data:; media-src data:; base-uri 'none'; form-action 'none'"
    )


def save_figures(sections: Iterable[Section], folder: Path) -> list[Path]:
    """Write the figures of some sections as PNG, named by their captions."""
    from identification.report.style import save_png, settle

    paths = []
    for caption, figure in (each for section in sections for each in section.figures):
        settle(figure)  # a report shows it too
        name = re.sub("[^a-z0-9]+", "-", caption.lower()).strip("-")
        paths.append(save_png(figure, folder / f"{name}.png"))
    return paths


def _section(section: Section, number: int, drawings: dict[Figure, str]) -> dict[str, Any]:
    table = section.table
    for k, (caption, figure) in enumerate(section.figures, 1):
        if figure not in drawings:
            drawings[figure] = drawing(figure, f"f{number}_{k}_", caption)
    return {
        "title": section.title,
        "name": f"part-{number}",
        "first": section.first,
        "paragraphs": [part.strip() for part in section.text.split("\n\n") if part.strip()],
        "figures": [
            (
                caption,
                drawings[figure],
                figure.get_size_inches()[0] >= WIDE,
                float(figure.get_size_inches()[0]),
            )
            for caption, figure in section.figures
        ],
        "columns": columns_of(table.columns, table.rows) if table else [],
        "rows": [[text_of(cell) for cell in row] for row in table.rows] if table else [],
        "folded": table is not None and len(table.rows) > LONG,
        "video": video_source(section.video) if section.video else None,
        "poster": image_source(section.poster) if section.poster else None,
    }
