"""A declared sampling time against the stamps of a log: where rows are missing, or it is wrong.

    o_k = t_k - t_0 - k T        a grid fits rows while all o_k lie within one quantum

Where rows are missing, o jumps ahead by their number times T, and T fits the rows before the gap
and those behind it. A step that is too large lets o fall behind, which no missing row does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import (
    MIN_ROWS,
    FloatArray,
    check_time,
    float_resolution,
    off_grid,
    sampling_time,
)
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table

FEW = 2  # places where rows are missing, of any length
MOST = 0.05  # of the rows, that may be missing in more places: a wrong step looks like these, too


@dataclass(frozen=True)
class Missing:
    """Rows that are missing where a declared step fits the rows before and behind.

    Attributes:
        row: the first row behind them.
        count: how many there are, give or take what a quantum hides.
    """

    row: int
    count: int


def missing_rows(time: FloatArray, width: FloatArray, step: float) -> list[Missing]:
    """Finds the places where missing rows explain that a step does not fit all stamps.

    Args:
        time: stamps, shape (n,) [s].
        width: how far each may be off the grid, shape (n,) [s].
        step: of the grid [s].

    Returns:
        The places in their order; none where missing rows do not explain it.
    """
    off = off_grid(time, step)
    low, high, least = off - width, off + width, float_resolution(time)
    begins, middles = [0], []
    while True:
        begin = begins[-1]
        lowest = np.maximum.accumulate(low[begin:])
        highest = np.minimum.accumulate(high[begin:])
        bad = np.flatnonzero(~(lowest <= highest + least))
        end = int(bad[0]) if bad.size else len(lowest)
        if end < MIN_ROWS:
            return []
        middles.append(float(lowest[end - 1] + highest[end - 1]) / 2)
        if not bad.size:
            break
        begins.append(begin + end)
    counts = np.rint(np.diff(middles) / step).astype(int).tolist()
    if not counts or min(counts) < 1:
        return []
    if len(counts) > FEW and sum(counts) > MOST * len(time):
        return []
    return [Missing(row, count) for row, count in zip(begins[1:], counts, strict=True)]


def missing_sentence(table: Table, places: Sequence[Missing], sidecar: Sidecar) -> str:
    """Returns words that tell where rows are missing, and how many."""
    row, time = places[0].row, table["time"]
    rest = len(places) - 1
    more = f", and in {rest} more place{'s' * (rest > 1)}" if rest else ""
    rows = "1 row is" if places[0].count == 1 else f"{places[0].count} rows are"
    return (
        f"{table.place(row - 1)}: about {rows} missing behind it: sampling_time ="
        f" {sidecar.sampling_time:.6g} in {sidecar.file_of('sampling_time')} fits the rows up to"
        f" {time[row - 1]:.9g} s and those from {time[row]:.9g} s on, but not both at once{more}"
    )


def refuse_wrong_step(table: Table, proven: float | None, sidecar: Sidecar, exact: float) -> None:
    """Refuse a declared sampling time where the log is even with another one.

    Where most rows have empty cells, each channel has steps of its own, and nothing is refused.

    Args:
        table: of the log, with stamps in s.
        proven: the sampling time that its coarse stamps prove [s]; None where they prove none.
        sidecar: it gives the sampling time.
        exact: relative difference that is no contradiction, such as that of two clocks.
    """
    declared, step = sidecar.sampling_time, proven or _even_step(table)
    if not declared or not step or np.isnan(table.data).any(axis=1).mean() >= 0.5:
        return
    if abs(declared - step) <= exact * step:
        return
    thin = " (a log is thinned by every = ... in the robot's file)" if declared > step else ""
    raise InputError(
        f"{sidecar.file_of('sampling_time')} says sampling_time = {declared:.6g}, and the stamps of"
        f" {table.path} are even with a step of {step:.6g} s; correct sampling_time or leave it"
        f" out{thin}"
    )


def _even_step(table: Table) -> float | None:
    """Returns the step [s] of stamps that are even by themselves, else None."""
    try:
        check_time(table["time"], table.place)
    except InputError:
        return None
    return sampling_time(table["time"])
