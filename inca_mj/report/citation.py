"""Citations of the program, and of the thesis whose equations it computes."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

Work = dict[str, str]  # what a bibliography says of a work, by the keys of `THESIS`

THESIS = {
    "key": "inca_thesis",  # of its BibTeX entry
    "kind": "thesis",  # or software
    "title": "Modélisation et identification d'un robot à câbles",
    "author": "Équipe Automatique, Vision et Robotique (eAVR)",
    "version": "",  # of a software
    "license": "",  # SPDX name
    "where": "Laboratoire des Sciences de l'Image, de l'Informatique et de la Télédétection,"
    " Strasbourg",
    "note": "the title page with the author's name and the year is missing in the text that this"
    " project works from",
}


def software() -> Work:
    """Returns this program, in the version that is installed."""
    try:
        number = version("inca-mj")
    except PackageNotFoundError:  # run from a source tree
        number = ""
    return {
        "key": "inca_mj",
        "kind": "software",
        "title": "inca_mj: the digital twin of a cable robot in MuJoCo, and the search for what it"
        " lacks",
        "author": "The inca_mj authors",
        "version": number,
        "license": "Apache-2.0",
        "where": "",
        "note": "",
    }


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
    about = [work["where"], work["version"] and f"version {work['version']}", work["license"]]
    rest = "".join(f", {part}" for part in about if part)
    note = f" ({work['note']})" if work["note"] else ""
    return f"{work['author']}: {work['title']}{rest}.{note}"


def _entry(work: Work) -> str:
    fields = {
        "title": f"{{{work['title']}}}",
        "author": f"{{{work['author']}}}",
        "version": work["version"],
        "school": work["where"],
        "note": work["note"] or work["license"],
    }
    kind = "software" if work["kind"] == "software" else "mastersthesis"
    body = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items() if value)
    return f"@{kind}{{{work['key']},\n{body}\n}}"
