"""Advice for messages: what to write into a log's TOML so that the log is read in another way."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from identification.logs.names import listed
from identification.storage.files import toml_key


def how_to_turn(
    columns: Sequence[str],
    factors: Mapping[str, float] | None = None,
    instead: str = "",
    renamed: bool = False,
) -> str:
    """Says how to turn the sign of some columns of a log's file.

    Args:
        columns: of the file.
        factors: those that the log's TOML gives, by column; None where they are not known.
        instead: other columns that may be turned as well, such as ", or of force".
        renamed: whether these are the new names of columns.
    """
    is_known, factors, cures = factors is not None, factors or {}, []
    if given := [n for n in columns if n in factors]:
        text = listed(f"{factors[n]:g} of {n}" for n in given)
        cures.append(f"turn the sign of the factor {text} that the log's TOML gives")
    if new := [n for n in columns if n not in factors]:
        text = lines_of([f"{toml_key(name)} = -1" for name in new])
        cures.append(f"write {text} under [factors] of the log's TOML")
        if not is_known:
            its = f"{new[0]} already has a factor" if len(new) == 1 else "a factor already stands"
            cures.append(f"or, if {its} there, change the sign of that factor instead")
    if not (new or instead):
        return cures[0]
    how = (", " if not given else ", and ").join(cures)
    the = "the new " if renamed else ""
    return f"turn the sign of {the}{listed(columns)}{instead}: {how}"


def how_to_rename(names: Mapping[str, str]) -> str:
    """Says how to give columns of a log new names, by the old ones, all at once.

    A file that already gives names there has other columns; so the names may also be changed there.
    """
    text = lines_of([f"{toml_key(old)} = {json.dumps(new)}" for old, new in names.items()])
    return (
        f" under [columns] of the log's TOML: write {text}, or change the names there if it"
        " already gives these columns some"
    )


def how_to_exchange(a: str, b: str) -> str:
    """Says how to exchange two columns of a log."""
    return f"exchange {a} and {b}{how_to_rename({a: b, b: a})}"


def unit_lines(units: Mapping[str, str]) -> str:
    """Says how to give the units of some columns of a log, by column or by group."""
    text = lines_of([f"{toml_key(name)} = {json.dumps(word)}" for name, word in units.items()])
    return f"write {text} under [units] of the log's TOML"


def lines_of(told: Sequence[str]) -> str:
    """Returns lines of TOML as part of a sentence."""
    return " and ".join(told) + (" (a line each)" if len(told) > 1 else "")
