"""Judgements of a log that a user may overrule, because he knows better than a check."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from identification.errors import unknown_name

TRUST = {  # what a user may know better than a check
    "contacts": "geoms that touch all along the log are meant to",
    "gaps": "what is made up across a gap counts as measured",
    "joints": "joints that no sensor measures and nothing holds begin where the model does",
    "rows": "all rows are of this robot, also a few with one stamp, and those of zeros",
    "sensors": "a sensor that repeats one value is not frozen",
    "start": "simulations begin where the model does, also where the log begins elsewhere",
    "steps": "the model's steps are fine enough",
    "time": "the log's time is in seconds",
    "units": "the outputs are in the units that the log says",
    "wiring": "the signs and the order of the columns are right",
}


def trusted(words: Sequence[Any], where: str, judged: Mapping[str, str] = TRUST) -> tuple[str, ...]:
    """Returns the judgements that a user overrules."""
    for word in words:
        if str(word) not in judged:
            raise unknown_name(f"word {where}:", str(word), judged)
    return tuple(words)
