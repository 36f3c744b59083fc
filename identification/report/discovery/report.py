"""The report of a discovery: text for a terminal, and a one-file page with its headline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite, isinf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from identification.discovery.effect_results import NamedEffect
from identification.discovery.result import Discovery
from identification.effects.named import phrase_there
from identification.quantities import held
from identification.report.discovery.effect_sections import (
    added_section,
    rivals_section,
    tried_section,
)
from identification.report.discovery.horizon_section import horizon_sections
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.law import law_sections
from identification.report.discovery.missing_place import find_place
from identification.report.discovery.named_words import (
    confidence_of_set,
    curve_top,
    is_likeliest,
    likely_rivals,
    rival_words,
)
from identification.report.discovery.nothing_words import is_above_noise
from identification.report.discovery.sections import (
    gap_section,
    parameters_section,
    records_section,
    shifts_section,
    steps_taken,
    where_section,
)
from identification.report.discovery.shown_words import unseen_section
from identification.report.discovery.verdict import discovery_verdict, further_sentences
from identification.report.page.headline import Answer, Headline, Tile, capital, error_tile
from identification.report.page.page import Section, write_report
from identification.report.page.page_files import PageFiles
from identification.report.words.effects import (
    none_explains,
    number,
    say_choice,
    shown_parameters,
)
from identification.report.words.parts import unseen_of
from identification.report.words.rest import are_all_resting
from identification.report.words.values import without_colon
from identification.shares import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def discovery_text(found: Discovery) -> str:
    """Returns the whole outcome as text: the verdict first, then what was added and the rest."""
    sections = [
        added_section(found),
        gap_section(found),
        *records_section(found),
        parameters_section(found),
        *shifts_section(found),
        *where_section(found),
        *horizon_sections(found),
        rivals_section(found),
        *tried_section(found),
        *unseen_section(found),
    ]
    parts = [
        "\n".join(discovery_verdict(found)),
        *(section.plain for section in sections),
        "\n".join(further_sentences(found)),
        *steps_taken(found),
        f"The search took {found.took:.1f} s, without reading the logs and drawing the report.",
    ]
    return "\n\n".join(filter(None, parts))


def discovery_sections(found: Discovery, files: str = "") -> list[Section]:
    """Returns the sections of every page on a discovery; `files` says where the new model is."""
    return [
        gap_section(found),
        *records_section(found),
        *law_sections(found),
        *where_section(found),
        *horizon_sections(found),
        rivals_section(found),
        *tried_section(found),
        added_section(found, files),
        parameters_section(found),
        *shifts_section(found),
        *unseen_section(found),
    ]


def write_page(
    found: Discovery,
    path: Path,
    sections: Sequence[Section],
    sentences: Sequence[str] = (),
    drawings: dict[Figure, str] | None = None,
) -> Path:
    """Write the report of a discovery, one HTML file of some sections; returns its path."""
    is_open = found.verdict == "nothing missing" and is_above_noise(found)
    fitted = [record.log.name for record in found.records if record.role == "fit"]
    return write_report(
        path,
        f"{', '.join(fitted)}: what the model lacks",
        [*discovery_verdict(found), *sentences],
        sections,
        good=None if is_open else found.is_good,
        data=[record.log.name for record in found.records],
        drawings=drawings,
        headline=discovery_headline(found),
        further=further_sentences(found),
    )


UNSEEN = "error on unseen data"


def discovery_headline(found: Discovery) -> Headline:
    """Returns the answer of a discovery in a few words and numbers."""
    if found.named:
        error = error_tile(
            found.errors_of(found.before), found.errors_of(found.after), found.floor,
            f"{UNSEEN}{unseen_of(found)}{found.over}",
        )  # fmt: skip
        answers = [_named(found, named) for named in found.named]
        first = answers[0]
        answers[0] = Answer(first.name, first.place, (*first.tiles, error))
        return Headline(_lead(found), tuple(answers))
    left = error_tile(
        found.errors_of(found.before), None, found.floor, f"{UNSEEN}{unseen_of(found)}{found.over}"
    )  # fmt: skip
    tried = len({s.candidate.effect.name for s in found.scores})
    none = f"{capital(none_explains(tried))} it."
    if found.verdict == "unknown effect":
        ratio = found.times_noise(found.before)
        note = f"on unseen data{unseen_of(found)}"
        much = Tile("times the noise", held(ratio), note) if isfinite(ratio) else None
        at = find_place(found)
        missing = Tile(f"missing on {at.joint}", at.size, at.range) if at else None
        tiles = [missing, left, much]
        where = f"{none}" if at is None else f"at joint {at.joint}. {none}"
        return Headline("", (Answer("Something is missing", where, _three(tiles)),))
    seen = {d.candidate.effect.name for d in found.detectable if d.is_plausible}
    told = {d.candidate.effect.name for d in found.detectable}
    shown = Tile("known effects that would have shown", f"{len(seen)} of {len(told)}",
                 "in 9 logs of 10, at a plausible size")  # fmt: skip
    known = Tile("known effects tried", str(tried))
    name, place = "Nothing is missing", "as far as these data can tell"
    if are_all_resting(found):
        place = "as far as data can tell in which the robot hardly moves"
    if is_above_noise(found):
        name, place = "No effect is named", "No candidate lowers the error beyond chance."
    return Headline("", (Answer(name, place, _three([left, shown if told else None, known])),))


def _lead(found: Discovery) -> str:
    """Returns the words above the first name; they say where a name is one of a set."""
    sets = [n for n in found.named if n.one_of and n.rivals]
    if found.verdict == "unlisted effect":
        return "Missing from the model, in no catalogue and drawn from the data"
    if len(found.named) > 1:
        each = ". A name with “or” is one of those that are told with it" if sets else ""
        return f"Missing from the model, together{each}"
    if not sets:
        return "Missing from the model"
    first = (
        "most likely the first" if is_likeliest(sets[0]) else "and the first is not the likeliest"
    )
    return f"Missing from the model is one of these, {first}"


def _named(found: Discovery, named: NamedEffect) -> Answer:
    """Returns the answer on a named effect, or on the set to which it belongs."""
    plant, rivals = found.final.plant, likely_rivals(named)
    name, place = without_colon(phrase_there(named.candidate, plant)), named.candidate.where
    own = percent(named.confidence)
    note = "the highest that is said" if not named.compared else ""
    if named.compared:
        note = f"{named.compared} rival{'s' if named.compared > 1 else ''} refitted in its place"
    if named.one_of and rivals:
        others = [rival_words(r, plant) for r in rivals]
        place = f"{place} ({own}); or {'; or '.join(others)}"
        total = percent(confidence_of_set(found, named))
        confidence = Tile("confidence, together", total, f"{own} for the first alone")
    else:
        confidence = Tile("confidence", own, note)
    return Answer(capital(name), place, (*_size(found, named), confidence))


def _size(found: Discovery, named: NamedEffect) -> tuple[Tile, ...]:
    """Returns the tile on how large a named effect is; none where no number is known."""
    if named.candidate.effect.is_curve:
        return (Tile("largest force", *curve_top(named, found.final.plant)),)
    about = named.candidate.effect.about
    words, numbers = [], []
    for name, (value, std, unit) in shown_parameters(named).items():
        if said := say_choice(named.candidate, name, value):
            words.append(said)
        elif not isinf(std):
            numbers.append((name, number(named.candidate.effect, name, value, std, unit)))
    if not numbers:
        return (Tile("what it is", capital(words[0])),) if words else ()
    (first, size), *more = numbers
    note = [about[first]] if about.get(first) else []
    note += [f"{n} = {said}" for n, said in more] + words
    return (Tile(f"size {first}", size, "; ".join(note)),)


def _three(tiles: list[Tile | None]) -> tuple[Tile, ...]:
    return tuple(t for t in tiles if t is not None)[:3]


@dataclass(frozen=True)
class DiscoveryFiles(PageFiles):
    """The files of a discovery on a model by hand, which no file describes."""

    found: Discovery  # the discovery

    @property
    def record(self) -> dict[str, Any]:
        """The discovery as plain values."""
        return discovery_to_json(self.found)

    @property
    def sentences(self) -> Sequence[str]:
        """What is said behind the verdict."""
        return ()

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""
        return discovery_sections(self.found)

    @cached_property
    def drawings(self) -> dict[Figure, str]:
        """What was drawn for an earlier page, which the next page has too."""
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        return write_page(self.found, path, self.sections, self.sentences, self.drawings)
