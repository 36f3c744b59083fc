"""Stamps of time as recorders write them: nanoseconds since 1970, or seconds and nanoseconds apart.

1748873654316744521 ns has steps of 256 ns in a float. Stamps that a float cannot hold are therefore
read as they are printed, less the first one, so that such a log begins at zero.

    t = sec + 1e-9 nanosec          two columns, as a stamp of ROS has them
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from decimal import Decimal

import numpy as np

from identification.errors import InputError
from identification.logs.cures import lines_of, toml_key
from identification.logs.names import quoted
from identification.logs.sampling import FloatArray
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table

TIME = "time"
APART = ("time.sec", "time.nanosec")  # names that a user may give to two columns
WHOLE = 2.0**53  # from which a float does not hold every whole number
_NANO = re.compile(r"(.*?)(nanosec|nanosecond|nsec)s?", re.IGNORECASE)
_PARTS = {"nanosec": "sec", "nanosecond": "second", "nsec": "sec"}


def exact_stamps(cells: Sequence[str]) -> FloatArray:
    """Returns printed stamps less the first one, shape (n,), as exactly as a float holds these."""
    stamps = [Decimal(cell.strip()) for cell in cells]
    return np.array([float(stamp - stamps[0]) for stamp in stamps])


def stamps_apart(names: Sequence[str], sidecar: Sidecar) -> tuple[str, str] | None:
    """Returns the columns of seconds and of nanoseconds that make the time of a log.

    Returns:
        None where there is a column of time, or no such two columns.
    """
    if TIME in names or sidecar.sampling_time:
        return None
    if set(APART) <= set(names):
        return APART
    small = {n.lower(): n for n in names}
    pairs = []
    for name in names:
        if found := _NANO.fullmatch(name):
            seconds = found[1].lower() + _PARTS[found[2].lower()]
            pairs += [(small[s], name) for s in (seconds, f"{seconds}s") if s in small]
    if len(pairs) > 1:
        each = " or ".join(f"{quoted(a)} with {quoted(b)}" for a, b in pairs)
        lines = lines_of([f'{toml_key(n)} = "{to}"' for n, to in zip(pairs[0], APART, strict=True)])
        raise InputError(
            f"several columns may be the time of the log: {each}; choose one of them, such as"
            f" {lines} under [columns] in {sidecar.file_of('columns')}"
        )
    return pairs[0] if pairs else None


def with_time(table: Table, sidecar: Sidecar) -> tuple[Table, str]:
    """Returns a table with a column of time [s] made of two, and a sentence that tells it."""
    pair = stamps_apart(table.names, sidecar)
    if pair is None:
        return table, ""
    for key in ("units", "factors"):
        if TIME in getattr(sidecar, key):
            raise InputError(
                f"{sidecar.file_of(key)} gives time under {key!r}, and time is made of"
                f" {quoted(pair[0])} [s] and {quoted(pair[1])} [ns]; leave it out there"
            )
    for name in pair:
        bad = np.flatnonzero(~(np.mod(table[name], 1) == 0))
        if bad.size:
            raise InputError(
                f"{table.place(int(bad[0]))}, column {quoted(name)}: {table[name][bad[0]]:g} is no"
                " whole number, as a part of a stamp is; correct it, or name another column time"
            )
    whole = [10**9 * int(s) + int(n) for s, n in zip(*(table[name] for name in pair), strict=True)]
    first = whole[0] if max(map(abs, whole)) >= WHOLE else 0
    time = np.array([k - first for k in whole]) * 1e-9
    keep = [k for k, name in enumerate(table.names) if name not in pair]
    names = (TIME, *(table.names[k] for k in keep))
    data = np.column_stack([time, table.data[:, keep]])
    said = f"Time of log {table.path.stem!r} is {quoted(pair[0])} [s] + {quoted(pair[1])} [ns]."
    return replace(table, names=names, data=data), "" if pair == APART else said


def wanted_columns(asked: set[str], sidecar: Sidecar) -> Callable[[Sequence[str]], set[str]]:
    """Returns a function that says which columns of a file are to be read, of all its columns."""
    to = sidecar.columns

    def wanted(names: Sequence[str]) -> set[str]:
        pair = stamps_apart([to.get(n, n) for n in names], sidecar) or ()
        return {n for n in names if to.get(n, n) in {*asked, *pair}}

    return wanted
