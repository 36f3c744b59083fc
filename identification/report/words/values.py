"""Parameters and sizes of effects in words: what a value is, of which record or part, and how far.

A value that left what was known by several std stands for something else: the model lacks an
effect that the value imitates, or what was known of it is wrong.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from identification.quantities import held
from identification.report.words.errors import listed

if TYPE_CHECKING:
    from identification.discovery.fitted import Fitted
    from identification.discovery.result import Discovery
    from identification.effects.effect import Effect
    from identification.model.parameter import Parameter
    from identification.model.predictor import Plant

PART = re.compile(r"(?P<what>.+?)(?P<sign>, [^\W\d]+ |@)(?P<number>\d+)")  # one of several alike


def phrase(effect: Effect) -> str:
    """Returns an effect in words without a colon, because sentences have their own before it."""
    return without_colon(effect.phrase or effect.name.replace("_", " "))


def without_colon(said: str) -> str:
    """Returns words of a catalogue for a sentence that has a colon of its own."""
    return said.replace(": ", " – ", 1)


def describe_parameter(parameter: Parameter) -> str:
    """Returns what a parameter is, its letter before the place; its name where that is not said."""
    said, letter = parameter.short, parameter.letter
    if not said:
        return parameter.name
    if re.search(rf"(?<!\w){re.escape(letter)}(?!\w)", said):
        return said
    what, comma, where = said.partition(",")
    return f"{what} {letter}{comma}{where}"


def parameter_words(
    parameters: Iterable[Parameter], effects: Iterable[Effect] = ()
) -> dict[str, str]:
    """Returns the words of parameters by name, also of effects, whose sizes are told with place."""
    words = {p.name: describe_parameter(p) for p in parameters}
    count = Counter(words.values())
    # of an effect that has the same parameter at several joints the joint is told too
    words |= {
        name: f"{said}, {place}"
        for name, said in words.items()
        if count[said] > 1 and (place := name.partition("@")[2])
    }
    for effect in effects:
        what = phrase(effect)
        words |= {f"{effect.name}.{shape.name}": f"{shape.name}, {what}" for shape in effect.shapes}
        words |= {
            effect.parameter(size.name, where): _size_words(effect, size.name, where)
            for size in effect.sizes
            for where in effect.places
        }
    return words


def _size_words(effect: Effect, size: str, where: str) -> str:
    """Returns what a size is called: in few words where the name of a record will follow."""
    if not effect.own:
        return f"{size}, {phrase(effect)}, {where}"
    from identification.effects.effect import BY_RECORD  # slow to import

    letter = f" {size}" if len(effect.sizes) > 1 else ""
    return f"{effect.name.replace('_', ' ')}{letter}, {where.removesuffix(BY_RECORD)}"


def words_of(found: Discovery) -> dict[str, str]:
    """Returns the words of all values of a discovery by name, also of those of single records."""
    told = [*found.nominal.told_values, *found.final.told_values]
    named = [each.candidate for each in found.named]
    effects = [c.effect for c in named]
    differing = [each.candidate.effect for each in found.differences]
    words = value_words(told, found.final.plant, [*differing, *effects])
    for c in named:  # a shape is one for all places of its effect, and is told of these
        for shape in c.effect.shapes:
            words[f"{c.effect.name}.{shape.name}"] += f", {c.where}"
    return words


def value_words(
    names: Iterable[str], plant: Plant, effects: Iterable[Effect] = ()
) -> dict[str, str]:
    """Returns the words of fitted values by name.

    The value of a single record, such as `time_shift.tau@u [a]`, is "time shift of record a, input
    u".
    """
    own = [e for e in getattr(plant, "effects", ()) if e.own]  # a model without effects has none
    words = parameter_words(plant.parameters, [*own, *effects])
    return words | {n: said for n in names if n not in words and (said := in_record(n, words)) != n}


def in_record(name: str, words: Mapping[str, str]) -> str:
    """Returns what `NAME [RECORD]` is called; the name itself where it has no record."""
    common, bracket, record = name.partition(" [")
    if not bracket:
        return name
    what, comma, where = words.get(common, common).partition(",")
    return f"{what} of record {record.removesuffix(']')}{comma}{where}"


def gathered(told: Iterable[str]) -> list[str]:
    """Returns words or names of parameters, those of the same one at several parts as one.

    friction smoothness β, drive 1; friction smoothness β, drive 2 -> ... β of drives 1 to 2
    """
    groups: dict[tuple[str, str], list[int]] = {}
    for each in told:
        part = PART.fullmatch(each)
        at = groups.setdefault((part["what"], part["sign"]) if part else (each, ""), [])
        at += [int(part["number"])] if part else []
    return [_gathered(what, sign, sorted(at)) for (what, sign), at in groups.items()]


def _gathered(what: str, sign: str, at: Sequence[int]) -> str:
    if len(at) < 2:
        return f"{what}{sign}{at[0]}" if at else what
    is_run = [*at] == [*range(at[0], at[-1] + 1)]
    which = f"{at[0]} to {at[-1]}" if is_run else ", ".join(map(str, at))
    return f"{what}@{which}" if sign == "@" else f"{what} of {sign.strip(', ')}s {which}"


def is_part(name: str) -> bool:
    """Returns whether a parameter is the deviation of one of many parts that are alike."""
    return "@" in name and "." not in name


FAR = 3.0  # std of what was known: one value in 400 of a right model is farther


def departure_sentences(model: Fitted, words: Mapping[str, str] | None = None) -> list[str]:
    """Returns a sentence on the values that are far from what was known; none where none is."""
    far = {n: abs(by) for n, by in model.departures.items() if abs(by) > FAR and not is_part(n)}
    if not far:
        return []
    farthest_first = sorted(far, key=lambda n: -far[n])
    told = [f"{(words or {}).get(n, n)} by {held(far[n])} std" for n in farthest_first]
    return [
        f"The fit moved values far from what was known of them: {listed(told)}. Either the model"
        " lacks something that they imitate, or what was known is wrong."
    ]


def departures_found(found: Discovery) -> list[str]:
    """Returns sentences on the values that a discovery's fits moved far from what was known."""
    words = words_of(found)
    final = departure_sentences(found.final, words)
    if not found.named:
        return final
    before = departure_sentences(found.nominal, words)
    return [*final, *(f"Before anything was named: {s[0].lower()}{s[1:]}" for s in before)]
