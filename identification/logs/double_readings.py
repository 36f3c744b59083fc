"""Two mistakes in one log: columns of a kind in another unit, and a sign that is turned.

Neither of the two readings explains such a log by itself, so that each alone would pass it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain

import numpy as np

from identification.logs.log import Log
from identification.logs.readings import Reading, input_turns, output_turns, unit_readings


def double_readings(
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
    for turn in chain(output_turns(log, bad, column), input_turns(log, bad, column)):
        for unit in unit_readings(turn.log, bad, column, wanted, alone=False):
            yield Reading(
                unit.log,
                sorted({*turn.columns, *unit.columns}),
                f"{unit.said} and {turn.said}",
                f"{unit.cure}, and {turn.cure}",
                (*unit.kinds, *turn.kinds),
            )
