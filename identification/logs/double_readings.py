"""Two mistakes in one log: a sign that is turned, and another unit or two columns exchanged.

Neither of the two readings explains such a log by itself, so that each alone would pass it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain

import numpy as np

from identification.logs.log import Log
from identification.logs.readings import (
    Reading,
    input_exchanges,
    input_turns,
    output_exchanges,
    output_turns,
    unit_readings,
)


def turned_units(
    log: Log,
    bad: np.ndarray,
    column: Mapping[str, str],
    wanted: Mapping[str, str] | None = None,
) -> Iterator[Reading]:
    """Another unit of all columns of a kind, with the other sign of an output or an input.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output or input is called in the log's file.
        wanted: SI unit by name of the inputs that a drive compares with its joint's own motion.
    """
    for turn in _turns(log, bad, column):
        for unit in unit_readings(turn.log, bad, column, wanted, alone=False):
            yield _both(unit, turn, "and")


def turned_exchanges(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Two outputs or two inputs exchanged, and the other sign of an output or an input.

    A sign belongs to a column as it is called after the exchange, as the TOML of a log reads it;
    which of its factors that column then has is not known here.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output or input is called in the log's file.
    """
    pairs = chain(output_exchanges(log, bad, column), input_exchanges(log, bad, column))
    for exchange in pairs:
        for turn in _turns(replace(exchange.log, factors={}), bad, column):
            yield _both(exchange, turn, "and, so named,", turn.log)


def _turns(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    yield from output_turns(log, bad, column)
    yield from input_turns(log, bad, column)


def _both(first: Reading, turn: Reading, then: str, log: Log | None = None) -> Reading:
    """Two readings as one, of the log of the first if no other is given."""
    return Reading(
        first.log if log is None else log,
        sorted({*turn.columns, *first.columns}),
        f"{first.said} and {turn.said}",
        f"{first.cure}, {then} {turn.cure}",
        tuple(dict.fromkeys((*first.kinds, *turn.kinds))),
    )
