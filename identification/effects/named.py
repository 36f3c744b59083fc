"""What a name such as `coulomb_friction.f_c@slide` means, or which part of it is unknown."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from identification.effects.effect import Effect
from identification.effects.effect_parameters import effect_parameters
from identification.effects.kinds import about_names
from identification.errors import InputError, unknown_name


def means_effect(name: str, effects: Sequence[Effect]) -> bool:
    """Whether a name is meant to be a number of an effect, and not a path into the model."""
    near = get_close_matches(name.partition(".")[0], [e.name for e in effects], n=1)
    return "/" not in name and ("@" in name or bool(near))


def unknown_effect(what: str, name: str, effects: Sequence[Effect]) -> InputError:
    """An unknown name of an effect, the good ones, and when they begin with `slide_`."""
    names = [e.name for e in effects]
    note = about_names(name, names)
    said = str(unknown_name(what, name, names))
    return InputError(f"{said}.{note}" if note else said)


def unknown_number(name: str, effects: Sequence[Effect]) -> InputError:
    """What is wrong with a name that is no number of an effect."""
    head, _, rest = name.partition(".")
    size, at, place = rest.partition("@")
    own = next((e for e in effects if e.name == head), None)
    if own is None:
        return unknown_effect(f"effect in {name!r}:", head, effects)
    numbers = [p.name for p in effect_parameters(own)]
    # of a robot with slides and hinges each kind has effects of its own
    there = [p.name for e in effects for p in effect_parameters(e)
             if at and p.name.endswith(f"{head}.{size}@{place}")]  # fmt: skip
    if there:
        return unknown_name(f"number of {head}:", name, there)
    if at and any(n.startswith(f"{head}.{size}@") for n in numbers):
        known = {at[1:]: where.partition(" ")[0] for where, at in own.places.items() if at}
        (kind,) = set(known.values())
        return unknown_name(f"{kind} in {name!r}:", place, known)
    return unknown_name(f"number of {head}:", name, numbers)
