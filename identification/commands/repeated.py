"""Options that take several values add up when they are repeated: --free A --free B is --free A B.

A parser that keeps the last of them would leave out what a user wrote, without a word. What follows
an option up to the next one belongs to it; several values are those of a field `tuple[X, ...]`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Annotated, Any, get_args, get_origin, get_type_hints


def gathered(commands: Any, arguments: Sequence[str]) -> list[str]:
    """Returns arguments in which each option of several values stands once, with all its values.

    Args:
        commands: dataclasses, or unions of them, as a parser takes them.
        arguments: those of the command line.
    """
    several = {f"--{name}" for name in _several(commands)}
    groups: list[list[str]] = [[]]
    first: dict[str, list[str]] = {}
    current = groups[0]
    for k, argument in enumerate(arguments):
        option, equals, value = argument.partition("=")
        option = option.replace("_", "-")
        if argument == "--":
            return [*chain(*groups), *arguments[k:]]
        if not argument.startswith("--"):
            current.append(argument)
            continue
        if option not in several:
            groups.append([argument])
        elif option not in first:
            first[option] = [option, value] if equals else [option]
            groups.append(first[option])
        elif equals:
            first[option].append(value)
        current = first.get(option, groups[-1])
    return [*chain(*groups)]


def _several(kind: Any) -> Iterator[str]:
    """Yields names of the options of several values, as written on the command line."""
    if get_origin(kind) is Annotated:
        yield from _several(get_args(kind)[0])
    elif isinstance(kind, type) and dataclasses.is_dataclass(kind):
        for name, hint in get_type_hints(kind).items():
            if dataclasses.is_dataclass(hint):
                yield from _several(hint)
            elif any(_is_several(each) for each in (hint, *get_args(hint))):
                yield name.replace("_", "-")
    else:
        for each in get_args(kind):
            yield from _several(each)


def _is_several(hint: Any) -> bool:
    return get_origin(hint) is tuple and get_args(hint)[1:] == (...,)
