"""Two mistakes in one log: a sign that is turned, and another unit, an exchange or another sign.

Neither of the two readings explains such a log by itself, so that each alone would pass it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain, combinations

import numpy as np

from identification.logs.cures import how_to_turn
from identification.logs.log import Log
from identification.logs.readings import (
    Reading,
    input_exchanges,
    input_turns,
    output_exchanges,
    output_turns,
    turned,
    unit_readings,
)


def turned_units(
    log: Log,
    bad: np.ndarray,
    column: Mapping[str, str],
    wanted: Mapping[str, str] | None = None,
) -> Iterator[Reading]:
    """Yields logs with another unit of a kind of columns and the other sign of an output or input.

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
    """Yields logs with two outputs or inputs exchanged and the other sign of an output or input.

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


def two_turns(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Yields logs with the other sign of two columns: of unexplained outputs, and of inputs.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output or input is called in the log's file.
    """
    wrong, ny = np.flatnonzero(bad).tolist(), log.outputs.shape[1]
    names = [column[n] for n in (*log.output_names, *log.input_names)]
    factors = {column[n]: f for n, f in log.factors.items() if n in column}
    for pair in combinations([*wrong, *range(ny, len(names))], 2):
        other = replace(
            log,
            outputs=turned(log.outputs, pair),
            inputs=turned(log.inputs, [k - ny for k in pair]),
        )
        of_outputs = [k for k in pair if k < ny]
        yield Reading(other, of_outputs if len(of_outputs) == 2 else wrong,
                      "with the other sign of two columns",
                      how_to_turn([names[k] for k in pair], factors))  # fmt: skip


def _turns(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    yield from output_turns(log, bad, column)
    yield from input_turns(log, bad, column)


def _both(first: Reading, turn: Reading, then: str, log: Log | None = None) -> Reading:
    """Returns two readings as one, of the log of the first if no other is given."""
    return Reading(
        first.log if log is None else log,
        sorted({*turn.columns, *first.columns}),
        f"{first.said} and {turn.said}",
        f"{first.cure}, {then} {turn.cure}",
        tuple(dict.fromkeys((*first.kinds, *turn.kinds))),
    )
