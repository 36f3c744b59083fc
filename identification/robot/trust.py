"""Judgements of a log that a user may overrule, because he knows better than a check."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from identification.errors import unknown_name

TRUST = {  # what a user may know better than a check
    "sensors": "a sensor that repeats one value is not frozen",
    "start": "simulations begin where the model does, also where the log begins elsewhere",
    "steps": "the model's steps are fine enough",
    "time": "the log's time is in seconds",
    "units": "the outputs are in the units that the log says",
    "wiring": "the signs and the order of the columns are right",
}


def trusted(words: Sequence[Any], where: str) -> tuple[str, ...]:
    """The judgements that a user overrules.

    Args:
        words: of `TRUST`.
        where: who gave them, for messages.

    Raises:
        InputError: a word is unknown.
    """
    for word in words:
        if str(word) not in TRUST:
            raise unknown_name(f"word under trust in {where}:", str(word), TRUST)
    return tuple(words)
