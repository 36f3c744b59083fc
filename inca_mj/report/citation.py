"""Citations of the program, and of the thesis whose equations it computes."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version


@dataclass(frozen=True)
class Work:
    """A work to cite."""

    key: str  # of its BibTeX entry
    kind: str  # software or thesis
    title: str  # its title
    author: str  # who wrote it; a name or a group
    version: str = ""  # of a software, else ""
    license: str = ""  # SPDX name, or ""
    where: str = ""  # the institution of a thesis, else ""
    note: str = ""  # what a reader should know


THESIS = Work(
    key="inca_thesis",
    kind="thesis",
    title="Modélisation et identification d'un robot à câbles",
    author="Équipe Automatique, Vision et Robotique (eAVR)",
    where="Laboratoire des Sciences de l'Image, de l'Informatique et de la Télédétection,"
    " Strasbourg",
    note="the title page with the author's name and the year is missing in the text that this"
    " project works from",
)


def software() -> Work:
    """Returns this program, in the version that is installed."""
    try:
        number = version("inca-mj")
    except PackageNotFoundError:  # run from a source tree
        number = ""
    return Work(
        key="inca_mj",
        kind="software",
        title="inca_mj: the digital twin of a cable robot in MuJoCo, and the search for what it"
        " lacks",
        author="The inca_mj authors",
        version=number,
        license="Apache-2.0",
    )


def works() -> tuple[Work, ...]:
    """Returns the works to cite: the program and the thesis."""
    return software(), THESIS


def to_text() -> str:
    """Returns one sentence for each work."""
    return "\n".join(_sentence(work) for work in works())


def to_bibtex() -> str:
    """Returns a BibTeX entry for each work."""
    return "\n\n".join(_entry(work) for work in works())


def _sentence(work: Work) -> str:
    about = [work.where, f"version {work.version}" if work.version else "", work.license]
    rest = "".join(f", {part}" for part in about if part)
    note = f" ({work.note})" if work.note else ""
    return f"{work.author}: {work.title}{rest}.{note}"


def _entry(work: Work) -> str:
    fields = {
        "title": f"{{{work.title}}}",
        "author": f"{{{work.author}}}",
        "version": work.version,
        "school": work.where,
        "note": work.note or work.license,
    }
    kind = "software" if work.kind == "software" else "mastersthesis"
    body = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items() if value)
    return f"@{kind}{{{work.key},\n{body}\n}}"
