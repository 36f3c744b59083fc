"""The answer at the head of a report: names in large letters, places, and tiles of numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from identification.report.words.errors import error_words

UNBROKEN = "\u00a0"  # a space at which no line ends


@dataclass(frozen=True)
class Tile:
    """One number of an answer."""

    label: str  # what it is
    value: str  # the number with its unit, in large letters; no line ends within a unit
    note: str = ""  # what stands below it in small letters

    def __post_init__(self) -> None:
        object.__setattr__(self, "value", re.sub(r"(?<=[^\W\d]) (?=[^\W\d])", UNBROKEN, self.value))


@dataclass(frozen=True)
class Answer:
    """A name in large letters, with its place and its numbers."""

    name: str  # what was found
    place: str = ""  # where it acts, or what limits the answer
    tiles: tuple[Tile, ...] = ()  # up to three


@dataclass(frozen=True)
class Headline:
    """What a reader of a report sees first."""

    lead: str  # words above the first name, such as "Missing from the model"
    answers: tuple[Answer, ...]  # one or several; the first one has the tile on the error


def error_tile(
    before: Mapping[str, float],
    after: Mapping[str, float] | None,
    noise: Mapping[str, float],
    what: str,
) -> Tile:
    """Returns the tile on the errors of two models, or of one, beside the noise.

    All are rms by unit: of the model before, of the one after (None where there is one model), and
    of the noise (zeros where it is not known).
    """
    told = [before, *([] if after is None else [after]), noise]
    sizes = error_words(told, "")
    if len(before) > 1:  # each has its kind of outputs in words, and a line of its own
        each = [size.replace(" and ", ", ").split(", ") for size in sizes[:-1]]
        value = "; ".join(" → ".join(_split(pair)) for pair in zip(*each, strict=True))
    else:
        value = " → ".join(_split(sizes[:-1]))
    return Tile(what, value, f"the noise is {sizes[-1]}" if any(noise.values()) else "")


def _split(sizes: Sequence[str]) -> list[str]:
    """Returns sizes of one unit, of which the last alone has the unit."""
    units = [size.partition(" ")[2] for size in sizes]
    if len(set(units)) > 1:
        return list(sizes)
    return [*(size.partition(" ")[0] for size in sizes[:-1]), sizes[-1]]


def capital(words: str) -> str:
    """Returns words that begin with a capital."""
    return words[:1].upper() + words[1:]
