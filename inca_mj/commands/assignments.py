"""Options that are given as NAME=VALUE: parameters, and effects with their sizes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from identification.effects.effect import Effect


def assignments(texts: Sequence[str], option: str, example: str = "m=0.2") -> dict[str, float]:
    """Returns the values of an option that is given as NAME=VALUE.

    Args:
        texts: what was given.
        option: its name.
        example: a right one.

    Raises:
        InputError: one is malformed, or a name is given twice.
    """
    from identification.errors import InputError

    values: dict[str, float] = {}
    for text in texts:
        left, equals, right = text.partition("=")
        name = left.strip()
        try:
            if not equals:
                raise ValueError
            value = float(right)
        except ValueError:
            raise InputError(f"{text!r} is not NAME=VALUE; write e.g. {option} {example}") from None
        if name in values:
            raise InputError(
                f"{option} gives {name} twice, {values[name]:g} and {value:g}; give it once"
            )
        values[name] = value
    return values


def effects_of(words: Sequence[str]) -> tuple[tuple[Effect, ...], dict[str, float]]:
    """Returns the effects of the catalogue that NAME.SIZE=VALUE words name, and their values.

    NAME alone stands for its first size, NAME.SIZE@3 for drive 3.

    Raises:
        InputError: a word is malformed, given twice, or names no effect or parameter of one.
    """
    from identification.errors import InputError, unknown_name
    from inca_mj.effects.catalogue import CATALOGUE
    from inca_mj.effects.values import records

    known = {effect.name: effect for effect in CATALOGUE}
    values: dict[str, float] = {}
    given = assignments(words, "--effect", "load_dependent_friction.mu=0.05")
    for word, value in given.items():
        name, _, place = word.partition("@")
        own, _, size = name.partition(".")
        if own not in known:
            raise unknown_name("effect", own, known)
        full = f"{own}.{size or known[own].sizes[0].name}" + (f"@{place}" if place else "")
        parameters = [p.name for p in records([known[own]])]
        if full not in parameters:
            raise unknown_name("parameter of an effect", full, parameters)
        if full in values:
            raise InputError(f"--effect gives {full} twice; give it once")
        values[full] = value
    named = {name.partition(".")[0] for name in values}
    return tuple(e for e in CATALOGUE if e.name in named), values
