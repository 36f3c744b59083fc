"""The headline of a discovery: names with place, size and confidence, and the errors."""

from __future__ import annotations

from math import isfinite, isinf

from identification.discovery.effect_results import NamedEffect
from identification.discovery.result import Discovery
from identification.effects.named import phrase_there
from identification.quantities import held
from identification.report.effect_words import (
    describe_there,
    none_explains,
    say_choice,
    shown_parameters,
    value_with_std,
)
from identification.report.headline import Answer, Headline, Tile, capital, error_tile
from identification.report.missing_place import find_place
from identification.report.named_words import curve_top, likely_rivals
from identification.report.nothing_words import is_above_noise
from identification.report.value_words import without_colon
from identification.shares import percent

UNSEEN = "error on unseen data"


def discovery_headline(found: Discovery) -> Headline:
    """Returns the answer of a discovery in a few words and numbers."""
    if found.named:
        error = error_tile(
            found.errors_of(found.before), found.errors_of(found.after), found.floor,
            f"{UNSEEN}{found.over}",
        )  # fmt: skip
        answers = [_named(found, named) for named in found.named]
        first = answers[0]
        answers[0] = Answer(first.name, first.place, (*first.tiles, error))
        return Headline(_lead(found), tuple(answers))
    left = error_tile(
        found.errors_of(found.before), None, found.floor, f"{UNSEEN}{found.over}"
    )  # fmt: skip
    tried = len({s.candidate.effect.name for s in found.scores})
    none = f"{capital(none_explains(tried))} it."
    if found.verdict == "unknown effect":
        ratio = found.times_noise(found.before)
        much = Tile("times the noise", held(ratio)) if isfinite(ratio) else None
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
    if is_above_noise(found):
        name, place = "No effect is named", "No candidate lowers the error beyond chance."
    return Headline("", (Answer(name, place, _three([left, shown if told else None, known])),))


def _lead(found: Discovery) -> str:
    """Returns the words above the first name."""
    if found.verdict == "unlisted effect":
        return "Missing from the model, in no catalogue and drawn from the data"
    if found.named[0].one_of and found.named[0].rivals:
        return "Missing from the model is one of these"
    return "Missing from the model" if len(found.named) == 1 else "Missing from the model, together"


def _named(found: Discovery, named: NamedEffect) -> Answer:
    """Returns the answer on a named effect, or on the set to which it belongs."""
    plant, rivals = found.final.plant, likely_rivals(named)
    name, place = without_colon(phrase_there(named.candidate, plant)), named.candidate.where
    own = percent(named.confidence)
    note = "the highest that is said" if not named.compared else ""
    if named.compared:
        note = f"{named.compared} rival{'s' if named.compared > 1 else ''} refitted in its place"
    if named.one_of and rivals:
        others = [describe_there(r.candidate, plant) for r in rivals]
        place = f"{place}; or {'; or '.join(others)}"
        total = percent(named.confidence + sum(r.confidence for r in rivals))
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
            numbers.append((name, value_with_std(value, std, unit)))
    if not numbers:
        return (Tile("what it is", capital(words[0])),) if words else ()
    (first, size), *more = numbers
    note = [about[first]] if about.get(first) else []
    note += [f"{n} = {said}" for n, said in more] + words
    return (Tile(f"size {first}", size, "; ".join(note)),)


def _three(tiles: list[Tile | None]) -> tuple[Tile, ...]:
    return tuple(t for t in tiles if t is not None)[:3]
