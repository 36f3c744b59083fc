"""What a user writes into the TOML of a log to read it in another way, for messages."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence

_BARE = re.compile(r"[A-Za-z0-9_-]+")  # a key that TOML takes without quotes


def how_to_turn(columns: Sequence[str]) -> str:
    """How to turn the sign of some columns of a log."""
    told = lines_of([f"{toml_key(name)} = -1" for name in columns])
    return f": write {told} under [factors] of the log's TOML, or turn the sign that it has"


def how_to_rename(names: Mapping[str, str]) -> str:
    """How to give columns of a log new names, by the old ones, all at once.

    A file that already gives names there has other columns; so the names may also be changed there.
    """
    told = lines_of([f"{toml_key(old)} = {json.dumps(new)}" for old, new in names.items()])
    return f" under [columns] of the log's TOML: write {told}, or change the names that it has"


def how_to_exchange(a: str, b: str) -> str:
    """How to exchange two columns of a log."""
    return f"exchange {a} and {b}{how_to_rename({a: b, b: a})}"


def unit_lines(units: Mapping[str, str]) -> str:
    """What says the units of some columns of a log, by column or by group."""
    told = lines_of([f"{toml_key(name)} = {json.dumps(word)}" for name, word in units.items()])
    return f"write {told} under [units] of the log's TOML"


def toml_key(name: str) -> str:
    """A name as a key of TOML, in quotes where it needs them."""
    return name if _BARE.fullmatch(name) else json.dumps(name)


def lines_of(told: Sequence[str]) -> str:
    """Lines of TOML in a sentence."""
    return " and ".join(told) + (" (a line each)" if len(told) > 1 else "")
