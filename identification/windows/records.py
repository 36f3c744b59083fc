"""The records of one robot, made of its logs: some are fitted, the others only confirm.

Where no record confirms, a log is cut into pieces, and some of them confirm. Two halves would
differ where a motion changes along a log, as a sweep of frequencies does: what acts at speed alone
would be in one of them. So the pieces of a long log take turns, in the order of Thue (1906) and
Morse (1921), which no steady growth of the motion favours:

    piece k confirms where the number of ones among the binary digits of k is odd
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain, repeat

import numpy as np

from identification.errors import InputError
from identification.logs.joined import Record as Record
from identification.logs.joined import Role, refuse_different
from identification.logs.log import Log

# Horizons that a piece of a log is long, at least: shorter ones have no room for windows of twice
# the horizon in all places.
PIECE_HORIZONS = 4  # horizons that a piece of a log is long, at least
COUNTS = (8, 4)  # of pieces; of a log that is too short for them its two halves are taken


def as_records(
    fit: Sequence[Log], confirm: Sequence[Log] = (), horizon: float | None = None
) -> tuple[Record, ...]:
    """Returns records to fit and records to confirm.

    Where nothing confirms, the part `estimation` of each log is fitted and its part `validation`
    confirms. A log that names no parts is cut into pieces that take turns, or into its halves.

    Args:
        fit: logs to fit.
        confirm: logs that no fit may see.
        horizon: of predictions [s]; without one, logs are cut into halves.

    Raises:
        InputError: there is no log to fit, the columns differ, or a log is given twice, in whole
            or in part.
    """
    if not fit:
        raise InputError("no log is to be fitted; give at least one")
    refuse_different([*fit, *confirm])
    named = _distinct([*fit, *confirm])
    if confirm:
        roles = chain(repeat(_FIT, len(fit)), repeat(_CONFIRM))
        return tuple(map(Record, named, roles, (log.values for log in named)))
    return tuple(
        Record(_part(log, part, horizon), role, log.values)
        for part, role in _HALVES
        for log in named
    )


def _part(log: Log, name: str, horizon: float | None) -> Log:
    """Returns the samples of a log's part; those of its other part are gaps of it."""
    if log.splits or horizon is None:
        return log.part(name)
    unit = 2 * round(horizon / log.sampling_time)  # the longest windows end where a piece does
    each = len(log) // unit if unit else 0
    count = next((n for n in COUNTS if each // n * 2 >= PIECE_HORIZONS), 0)
    if not count:
        return log.part(name)
    begins = unit * (np.arange(count) * each // count)
    ends = [*begins[1:], len(log)]
    is_late = [k.bit_count() % 2 == 1 for k in range(count)]
    others = [(a, b) for a, b, late in zip(begins, ends, is_late, strict=True)
              if late == (name == "estimation")]  # fmt: skip
    # Half a step inside the other piece, so that the windows beside it do not touch the gap.
    half = log.sampling_time / 2
    shut = [(float(log.time[a]) + half, float(log.time[b - 1]) - half) for a, b in others]
    return replace(log, gaps=(*log.gaps, *shut), name=f"{log.name} [{name}]")


_FIT: Role = "fit"
_CONFIRM: Role = "confirm"
_HALVES = (("estimation", _FIT), ("validation", _CONFIRM))


def _distinct(logs: Sequence[Log]) -> list[Log]:
    """Returns the logs under distinct names: a record's own values are told by its name."""
    out: list[Log] = []
    for log in logs:
        used = {other.name for other in out}
        name, k = log.name, 1
        while name in used:
            k += 1
            name = f"{log.name} ({k})"
        out.append(log if name == log.name else replace(log, name=name))
    return out
