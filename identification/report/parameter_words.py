"""Parameters in words, for readers: "cable elasticity λ, drive 5" and not `lambda@5`.

The words are those of the parameter's own record, its short name and its letter. JSON and files
keep the names.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from identification.discovery.result import Discovery
    from identification.effects.effect import Effect
    from identification.model.parameter import Parameter


def describe_parameter(parameter: Parameter) -> str:
    """Returns what a parameter is, its letter before the place; its name where that is not said."""
    if not parameter.short:
        return parameter.name
    return with_letter(parameter.short, parameter.letter)


def with_letter(words: str, letter: str) -> str:
    """Returns words with a letter of the equations before their first comma, if they lack it."""
    if re.search(rf"(?<!\w){re.escape(letter)}(?!\w)", words):
        return words
    what, comma, where = words.partition(",")
    return f"{what} {letter}{comma}{where}"


def parameter_words(
    parameters: Iterable[Parameter], effects: Iterable[Effect] = ()
) -> dict[str, str]:
    """Returns the words of some parameters by name.

    Args:
        parameters: of a robot.
        effects: those whose parameters may be among them; a size is said with its place.
    """
    from identification.report.effect_words import phrase

    words = {p.name: describe_parameter(p) for p in parameters}
    for effect in effects:
        what = phrase(effect)
        words |= {f"{effect.name}.{shape.name}": f"{shape.name}, {what}" for shape in effect.shapes}
        words |= {
            effect.parameter(size.name, where): f"{size.name}, {what}, {where}"
            for size in effect.sizes
            for where in effect.places
        }
    return words


def words_of(found: Discovery) -> dict[str, str]:
    """Returns the words of all parameters of a discovery by name."""
    effects = [named.candidate.effect for named in found.named]
    return parameter_words(found.final.plant.parameters, effects)
