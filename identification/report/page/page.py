"""A report: one HTML file with everything in it, that opens without a network."""

from __future__ import annotations

import re
import shlex
import sys
from base64 import b64encode
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import date
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.errors import InputError
from identification.report.page.headline import Headline
from identification.report.page.media import drawing, image_source, video_source
from identification.storage.files import read_text, write_text
from identification.storage.results import package_version

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure

    Figures = tuple[tuple[str, Figure], ...]

TEMPLATES = Path(__file__).parent / "templates"
LONG = 12  # rows: a table of more is folded
WIDE = 9.0  # a figure of so many inches has a row of its own
PACKAGE, SOURCE = "inca-mj", "of a source tree"
PROGRAMS = ("inca", "inca_mj", "identification")
NUMBER = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?")
# in body/arm.mass, and in no unit such as N/m or rad/s
PATH = re.compile(r"(?<=\w{3})[/.@](?=\w{2})(?![^<]*>|[^<]*</span)")
EMPTY = ("–", "unknown", None)  # in the place of a number
UNIT = r"[nµmkM]?(?:kg|rad|Hz|min|[gNmsAVWJh])(?:\^?-?[\d²³]+)?(?:/(?:\([^)]*\)|[\w²³^]+))?"
QUANTITY = re.compile(  # a number, its std, and a unit such as N m s/rad
    rf"[-+]?\d[\d.]*(?:e[-+]?\d+)?(?: ± [\d.]+(?:e[-+]?\d+)?)?(?: %|(?: {UNIT}(?![\w/]))+)"
)


@dataclass(frozen=True)
class Table:
    """A table of text and numbers."""

    columns: tuple[str, ...]  # headings, with units
    rows: tuple[tuple[object, ...], ...]  # as many cells each; numbers are set to the right

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise InputError(
                    f"a table of {len(self.columns)} columns has a row of {len(row)} cells"
                )

    @property
    def filled(self) -> Table:
        """The table without columns in which no row says anything."""
        if not self.rows:
            return self
        kept = [k for k, cells in enumerate(zip(*self.rows, strict=True))
                if k == 0 or any(c not in (None, "", "–") for c in cells)]  # fmt: skip
        rows = tuple(tuple(row[k] for k in kept) for row in self.rows)
        return Table(tuple(self.columns[k] for k in kept), rows)

    @property
    def last_first(self) -> Table:
        """The table with the last column behind the first, so that both fit a narrow screen."""
        (name, *middle, last) = self.columns
        rows = tuple((first, end, *rest) for first, *rest, end in self.rows)
        return Table((name, last, *middle), rows)

    @property
    def headings(self) -> list[tuple[str, bool]]:
        """Each heading, and whether numbers stand below it."""
        cells = zip(*self.rows, strict=True) if self.rows else ((),) * len(self.columns)
        return [(h, _holds_numbers(c)) for h, c in zip(self.columns, cells, strict=True)]


@dataclass(frozen=True)
class Section:
    """A part of a report."""

    title: str  # its heading
    text: str = ""  # paragraphs, parted by empty lines
    # figures by caption, or a cached function that draws them
    figures: Figures | Callable[[], Figures] = ()
    table: Table | None = None  # shown below the text; a long one is folded
    video: Path | None = None  # an mp4 file, shown last
    poster: Path | None = None  # a picture of the film, shown on paper
    # where its figures and its film stand above all sections: 1 above the verdict, 2 and 3 below it
    # in this order; 0 in the section itself
    first: int = 0
    plain: str = ""  # what a terminal prints of it, without its title; paragraphs likewise
    code: str = ""  # a file that a reader may copy, folded

    @property
    def drawn(self) -> Figures:
        """The figures by caption, drawn."""
        return self.figures() if callable(self.figures) else self.figures


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
    headline: Headline | None = None,
    further: Sequence[str] = (),
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
        headline: the answer in large letters; the title is then small.
        further: sentences behind the verdict, folded.

    Raises:
        InputError: a video cannot be read or is too large, or the file cannot be written.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    from identification.report.page.media import DARK

    script = f"\n//<![CDATA[\n{read_text(TEMPLATES / 'figures.js')}\n//]]>\n"
    environment = Environment(
        loader=PackageLoader("identification.report.page"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["whole"] = whole_quantities
    environment.filters["cell"] = breakable
    page = environment.get_template("report.html").render(
        title=title,
        file=Path(path).name,
        headline=headline,
        verdict=list(verdict),
        further=list(further),
        sections=[
            # Without drawings of an earlier page a figure that stands twice has names for each.
            _parts(section, number, {} if drawings is None else drawings)
            for number, section in enumerate(sections, 1)
        ],
        mood={True: "good", False: "bad", None: "plain"}[good],
        footer="\n".join(filter(None, [footer, origin(data)])),
        dark=DARK,
        script=Markup(script),
        policy=_policy(script),
    )
    return write_text(path, page)


def save_figures(sections: Iterable[Section], folder: Path) -> list[Path]:
    """Write the figures of some sections as PNG, named by their captions."""
    from identification.report.page.style import save_png, settle

    paths = []
    for caption, figure in (each for section in sections for each in section.drawn):
        settle(figure)  # a report shows it too
        name = re.sub("[^a-z0-9]+", "-", caption.lower()).strip("-")
        paths.append(save_png(figure, folder / f"{name}.png"))
    return paths


def origin(data: Sequence[str] = ()) -> str:
    """Returns lines that say what made a report: version, command, names of logs, and date."""
    lines = [
        f"{PACKAGE} {package_version(PACKAGE, SOURCE)} with MuJoCo {package_version('mujoco')}"
    ]
    if command := _command(sys.argv):
        lines.append(f"Command: {command}")
    if named := [name for name in data if name]:
        lines.append(f"Data: {', '.join(named)}")
    return "\n".join([*lines, f"Date: {date.today().isoformat()}"])


def whole_quantities(text: str) -> Markup:
    """Returns text, escaped, in which no line of a page ends between a number and its unit."""
    from markupsafe import Markup, escape

    return Markup(QUANTITY.sub(r'<span class="whole">\g<0></span>', str(escape(text))))


def breakable(text: str) -> Markup:
    """Returns a cell of a table, in which a line of a page may end within a long name or path."""
    from markupsafe import Markup

    return Markup(PATH.sub(r"\g<0><wbr />", str(whole_quantities(text))))


def _parts(section: Section, number: int, drawings: dict[Figure, str]) -> dict[str, Any]:
    """Returns what the template needs of a section."""
    figures, table = section.drawn, section.table and section.table.filled
    for k, (caption, figure) in enumerate(figures, 1):
        if figure not in drawings:
            drawings[figure] = drawing(figure, f"f{number}_{k}_", caption)
    width = [float(figure.get_size_inches()[0]) for _, figure in figures]
    paragraphs = [part.strip() for part in section.text.split("\n\n") if part.strip()]
    drawn = bool(figures or section.video)
    return {
        "title": section.title,
        "name": f"part-{number}",
        "first": int(section.first),
        "drawn": drawn,
        # what stands above, and has nothing else, needs no section of its own
        "shown": any((paragraphs, section.code, table and table.rows, drawn and not section.first)),
        "paragraphs": paragraphs,
        "code": section.code,
        "figures": [
            (caption, drawings[figure], inches >= WIDE, inches)
            for (caption, figure), inches in zip(figures, width, strict=True)
        ],
        "columns": table.headings if table else [],
        "rows": [[f"{cell:z.5g}" if isinstance(cell, float) else str("–" if cell is None else cell)
                  for cell in row] for row in table.rows] if table else [],
        "folded": table is not None and len(table.rows) > LONG,
        "video": video_source(section.video) if section.video else None,
        "poster": image_source(section.poster) if section.poster else None,
    }  # fmt: skip


def _holds_numbers(column: Iterable[object]) -> bool:
    """Returns whether some of the cells are numbers, or all of them are written numbers."""
    cells = list(column)
    written = [isinstance(c, str) and bool(NUMBER.fullmatch(c)) for c in cells]
    numbers = [isinstance(c, int | float) and not isinstance(c, bool) for c in cells]
    return any(numbers) or (
        any(written) and all(w or c in EMPTY for w, c in zip(written, cells, strict=True))
    )


def _policy(script: str) -> str:
    """Returns what a browser may do for a page that has one script: show what stands in it."""
    # No word of a log or a model can then run a script, or ask another computer for anything.
    # Styles may stand anywhere, because figures have some in their elements.
    digest = b64encode(sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline';"
        " img-src data:; media-src data:; base-uri 'none'; form-action 'none'"
    )


def _command(argv: Sequence[str]) -> str:
    """Returns the command line; empty where another program asked for the report."""
    path = Path(argv[0]) if argv else Path()
    name = path.parent.name if path.name == "__main__.py" else path.name
    if name not in PROGRAMS:
        return ""
    begin = "python -m inca_mj" if name == "inca_mj" else name
    return shlex.join([*begin.split(), *argv[1:]])
