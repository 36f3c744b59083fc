"""Errors of a model in words, by the unit of its outputs where they have several.

1.2 mrad rms                       outputs of one unit
1.2 mrad rms (angles) and 0.40 mm rms (slides)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.quantities import HELD, alike, held, quantity


def describe_scale(outputs: Mapping[str, str], scale: np.ndarray | None) -> list[str]:
    """Returns a sentence on what a mean square over unlike outputs is; none for outputs alike.

    `outputs` are their units by name; `scale` is what counts as one of each, shape (ny,), in its
    unit: its rms error under the nominal model; None where 1 counts alike in each unit.
    """
    units = [*dict.fromkeys(outputs.values())]
    if len(units) == 1:
        return []
    if scale is None:
        return [
            f"The outputs have several units ({', '.join(unit or 'none' for unit in units)}), and a"
            " free run counts an error of 1 in each of them alike, with one noise for all: give the"
            " nominal model a horizon, over which each output counts in its own scale."
        ]
    each = ", ".join(
        f"{quantity(float(s), unit=unit)} of {name}"
        for (name, unit), s in zip(outputs.items(), scale, strict=True)
    )
    return [
        "Before outputs of several units are taken together in one mean square, the error of each"
        f" is divided by its rms error under the fitted nominal model: {each}."
    ]


KINDS = {"rad": "angles", "m": "slides", "rad/s": "angular speeds", "m/s": "speeds of slides"}


def error_words(
    each: Sequence[Mapping[str, float]], word: str = "rms", digits: int = HELD
) -> list[str]:
    """Returns errors in words, those of one unit with one prefix, so that they compare at a glance.

    Each has the same units, and errors by unit and in it; the word follows each size, if there is
    one.
    """
    units = [*each[0]]
    columns = [alike([errors[unit] for errors in each], unit, digits) for unit in units]
    after = f" {word}" if word else ""
    if len(units) == 1:
        return [f"{size}{after}" for size in columns[0]]
    kinds = [kind(unit) for unit in units]
    rows = zip(*columns, strict=True)
    return [
        listed([f"{size}{after} ({what})" for size, what in zip(row, kinds, strict=True)])
        for row in rows
    ]


def change_words(
    before: Mapping[str, float],
    after: Mapping[str, float],
    beside: Sequence[Mapping[str, float]] = (),
) -> tuple[str, list[str]]:
    """Returns a change of errors, "from 3.7 mrad to 1.1 mrad rms", and other errors beside it."""
    told = [before, after, *beside]
    sizes = error_words(told, "")
    if len(before) == 1:
        return f"from {sizes[0]} to {sizes[1]} rms", sizes[2:]
    was, now = error_words(told)[:2]
    return f"from {was} to {now}", sizes[2:]


def times_words(errors: Mapping[str, float], of: Mapping[str, float]) -> str:
    """Returns errors by unit as multiples of others, one for each unit: 2.1 and 3.4."""
    return listed([held(e / of[unit]) if of[unit] > 0 else "∞" for unit, e in errors.items()])


def kind(unit: str) -> str:
    """Returns in words what outputs of a unit are."""
    return KINDS.get(unit, f"outputs in {unit}" if unit else "outputs without unit")


def listed(words: Sequence[str]) -> str:
    """Returns words joined by commas and an "and"."""
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))
