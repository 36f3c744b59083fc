"""Stamps of a clock that stood while rows were written.

    0, 0, 0, ... 0                     all along: time does not advance
    0, 0, ... 0, 0.01, 0.02, ...       up to a row, such as before the first message with a time
    0, 0.01, 0.02, 0.02, ... 0.02      from a row on

A clock that ticks too slowly makes runs of rows with one stamp too, but all of about one length; a
bus that delivers rows together makes one of them, before or behind which time jumps ahead by about
what it lasted.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import FloatArray, refuse_alike
from identification.logs.sidecar import Sidecar
from identification.logs.stamps.stamps import TIME, stamps_apart
from identification.logs.stamps.times import how_to_take, looks_like_time
from identification.logs.table import Table
from identification.storage.files import toml_value

FEWEST = 20  # rows in which a clock stood
LONGER = 5.0  # times as long as any other run of rows with one stamp
LOST = 0.5  # of the time in which they were written: such a jump of the stamps makes up for it


def columns_of_time(table: Table, sidecar: Sidecar) -> tuple[str, ...]:
    """Returns the columns of a log's file that make its time: one, two, or none."""
    olds = {new: old for old, new in sidecar.columns.items()}
    names = [sidecar.columns.get(n, n) for n in table.names if n not in sidecar.ignore]
    made_of = (TIME,) if TIME in names else stamps_apart(names, sidecar) or ()
    return tuple(olds.get(name, name) for name in made_of)


def refuse_standing(
    table: Table, time: FloatArray, columns: Sequence[str], sidecar: Sidecar
) -> None:
    """Refuse a table all of whose stamps are one.

    Args:
        table: of the log.
        time: its stamps, shape (n,) [s].
        columns: those of its file that make its time.
        sidecar: what its TOML says.
    """
    without = f"ignore = {toml_value([*columns])}"
    cure = (
        f"if the rows are even, write {without} and sampling_time = 0.01 (their step in s) into"
        f" {sidecar.path}, else record the log with its time"
    )
    but = {TIME, *columns, *sidecar.ignore}
    others = [n for n in table.all_names if looks_like_time(n) and n not in but]
    if others and len(columns) == 1:
        cure = f"{how_to_take(columns[0], others, sidecar.path)}; or, {cure}"
    refuse_alike(time, table.place, cure)


def refuse_stopped(table: Table, sidecar: Sidecar) -> None:
    """Refuse stamps of a clock that stood in a part of the log."""
    found = stopped(table[TIME])
    if found is None:
        return
    first, count = found
    n, stamp = len(table.data), table[TIME][first]
    when = "in these rows"
    if first == 0:
        when = "up to these rows' end"
    elif first + count == n:
        when = "from there on"
    raise InputError(
        f"{table.place(first)} and the {count - 1} rows after it have one stamp, {stamp:.9g} s:"
        f" time does not advance {when}; leave these rows out, or, if all rows of the log are even,"
        f" name the column of time under ignore in {sidecar.path}, and write sampling_time = 0.01"
        " (their step in s) into it"
    )


def stopped(time: FloatArray) -> tuple[int, int] | None:
    """Returns the first of the rows in which a clock stood, and how many; None where it did not.

    Args:
        time: stamps, none smaller than the one before, shape (n,) [s].
    """
    begins = np.flatnonzero(np.append(True, np.diff(time) > 0))
    counts = np.diff(np.append(begins, len(time)))
    if len(counts) < 2:
        return None
    longest = int(np.argmax(counts))
    count, others = int(counts[longest]), np.delete(counts, longest)
    if count < FEWEST or count <= LONGER * others.max():
        return None
    steps = np.diff(time[begins])
    around = steps[max(longest - 1, 0) : longest + 1]  # time jumps ahead before it, or behind
    if around.max() > LOST * count * float(np.median(steps)):
        return None
    return int(begins[longest]), count
