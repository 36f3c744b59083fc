"""Stamps of time as recorders write them: nanoseconds, in two columns, or one for several rows.

1748873654316744521 ns has steps of 256 ns in a float. Stamps that a float cannot hold are therefore
read as they are printed, less the first one, so that such a log begins at zero.

    t = sec + 1e-9 nanosec          two columns, as a stamp of ROS has them

Rows that share a stamp were written twice, sampled twice, or stamped by a clock that is too slow.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from decimal import Decimal

import numpy as np

from identification.errors import InputError
from identification.logs.cures import lines_of
from identification.logs.headers.headers import read_headers
from identification.logs.names import quoted
from identification.logs.sampling import FloatArray
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table
from identification.storage.files import toml_key

SURE = 4.0  # std of a sum of products that noise alone makes
ALIKE = (0.5, 2.0)  # of the motion between stamps, that there is within them, if both are one step
STILL = 0.25  # of the motion between stamps, below which there is none within them
TIME = "time"
APART = ("time.sec", "time.nanosec")  # names that a user may give to two columns
WHOLE = 2.0**53  # from which a float does not hold every whole number
_DATE = re.compile(r"(\d{4}-\d\d-\d\d)[Tt ](\d\d:\d\d:\d\d)(?:\.(\d+))? ?(Z|z|[+-]\d\d:?\d\d)?")
_NANO = re.compile(r"(.*?)(nanosec|nanosecond|nsec)s?", re.IGNORECASE)
_PARTS = {"nanosec": "sec", "nanosecond": "second", "nsec": "sec"}


def exact_stamps(cells: Sequence[str]) -> FloatArray:
    """Returns printed stamps less the first one, shape (n,), as exactly as a float holds these."""
    stamps = [Decimal(cell.strip()) for cell in cells]
    return np.array([float(stamp - stamps[0]) for stamp in stamps])


def seconds_of(cell: str) -> Decimal | None:
    """Returns the seconds of a date with its time, such as 2024-05-01T10:00:00.25Z; else None.

    They count from 1970 on, and a date without a zone is taken for one in UTC.
    """
    found = _DATE.fullmatch(cell.strip().strip('"').strip())
    if found is None:
        return None
    day, time, part, zone = found.groups()
    zone = "+00:00" if zone in (None, "Z", "z") else zone
    try:
        whole = datetime.fromisoformat(f"{day}T{time}{zone}").timestamp()
    except ValueError:  # such as a 13th month
        return None
    return Decimal(int(whole)) + Decimal(f"0.{part or 0}")


def dates_as_seconds(cells: Sequence[str]) -> list[str] | None:
    """Returns a column of dates as seconds from the first one; None where the first is no date.

    Cells that are no dates stay as they are.
    """
    stamps = [seconds_of(cell) for cell in cells]
    first = stamps[0] if stamps else None
    if first is None:
        return None
    return [cell if t is None else str(t - first) for cell, t in zip(cells, stamps, strict=True)]


def stamps_apart(names: Sequence[str], sidecar: Sidecar) -> tuple[str, str] | None:
    """Returns the columns of seconds and of nanoseconds that make the time of a log, or None."""
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


def with_time(table: Table, sidecar: Sidecar) -> Table:
    """Returns a table with a column of time [s] made of two, where it has two, which it tells."""
    pair = stamps_apart(table.names, sidecar)
    if pair is None:
        return table
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
    made = replace(table, names=names, data=data)
    text = f"Time of log {table.path.stem!r} is {quoted(pair[0])} [s] + {quoted(pair[1])} [ns]."
    return made if pair == APART else made.told(text)


def wanted_columns(asked: set[str], sidecar: Sidecar) -> Callable[[Sequence[str]], set[str]]:
    """Returns a function that says which columns of a file are to be read, of all its columns."""
    to = sidecar.columns

    def wanted(names: Sequence[str]) -> set[str]:
        by_header = read_headers(names, asked, sidecar)
        told = [to.get(n, n) for n in names if n not in sidecar.ignore]
        has_time = any(name == TIME for name, _ in by_header.values())
        pair = () if has_time else stamps_apart(told, sidecar) or ()
        return {n for n in names if to.get(n, n) in {*asked, *pair} or n in by_header}

    return wanted


def shared(time: FloatArray) -> np.ndarray:
    """Returns which stamps (n,) but the first are those of the row before them, shape (n - 1,)."""
    return np.asarray(time[1:] == time[:-1])


def without_repeated(table: Table) -> Table:
    """Returns a table without rows that were written twice, which it tells.

    Where a row that shares its stamp with the row before it has another cell, the table stays as it
    is; rows may then have been sampled in one tick of a clock.
    """
    before, after = table.data[:-1], table.data[1:]
    equal = ((before == after) | (np.isnan(before) & np.isnan(after))).all(axis=1)
    same = shared(table["time"])
    if not same.any() or not equal[same].all():
        return table
    keep = np.flatnonzero(np.append(True, ~same))
    kept = replace(table, data=table.data[keep], place=lambda row: table.place(int(keep[row])))
    n, log = int(same.sum()), f"of log {table.path.stem!r}"
    said = f"1 row {log} repeats the row before it to the last digit and was left out."
    if n > 1:
        said = f"{n} rows {log} repeat the row before them to the last digit and were left out."
    return kept.told(said)


def moves_on(time: FloatArray, x: FloatArray) -> bool | None:
    """Returns whether a channel (n,) goes on between rows of one stamp as it does between stamps.

        β = ⟨d s⟩,  d_k = x_{k+1} - x_k,  s_k = x_{k+2} - x_{k-1}

    d and s have no sample in common, so that noise adds nothing to the mean of their products. It
    is as large within stamps as between them where all rows are one step apart, and zero within
    them where a stamp was read twice. None is returned where noise hides it, or where the motion
    within stamps is another one. Cells where nothing stands are NaN.
    """
    seen = np.isfinite(x)
    t, x = time[seen], x[seen]
    largest = np.abs(x).max(initial=0.0)
    if len(t) < 4 or not largest:
        return None
    x = x / largest  # the products of products of large numbers exceed all floats
    product = np.diff(x)[1:-1] * (x[3:] - x[:-3])
    inside = shared(t)[1:-1]
    (within, sure, error), (between, clear, _) = (_mean(product[r]) for r in (inside, ~inside))
    if not clear or between <= 0:
        return None
    if sure and ALIKE[0] * between <= within <= ALIKE[1] * between:
        return True
    # Of a few rows that moved on, the mean may be small by chance.
    is_still = abs(within) < STILL * between and abs(within) + error < ALIKE[0] * between
    return False if is_still else None


def _mean(products: FloatArray) -> tuple[float, bool, float]:
    """Returns the mean of products, whether it is beyond chance, and its std."""
    if not products.size:
        return 0.0, False, 0.0
    size = float(np.sqrt(np.sum(products**2)))
    is_beyond = abs(float(products.sum())) > SURE * size
    return float(products.mean()), bool(is_beyond), size / products.size
