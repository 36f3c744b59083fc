"""Even logs whose stamps lost digits keep their rows, with the one step that fits all of them.

    |t_k - t_0 - k T| <= q_k/2    q_k   quantum of stamp k: its last digit, or a clock's tick
                                  T     the sampling time, one for all rows

"%.7g" prints 20000.005 s as 20000 or 20000.01: neighbouring rows get one stamp, others a gap, and
yet every row was sampled in its turn. All T that satisfy this form an interval. It proves an even
log where it is narrow, and where nothing else makes such stamps:

    steps of q and 2 q      dropped rows of an even log too; they do not come as regularly
    rows that share stamps  rows written twice too; within these the outputs do not move on
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import (
    JITTER,
    MIN_ROWS,
    FloatArray,
    check_time,
    grid,
    sampling_time,
)
from identification.logs.sidecar import Sidecar
from identification.logs.stamps.fitting_steps import EXACT, Stamps, fits, judged, missing_rows
from identification.logs.stamps.stamps import WHOLE, moves_on, shared
from identification.logs.stamps.standing import refuse_stopped
from identification.logs.table import Table

MEANT_EXACT = 1e-2  # the same where the user says that rows with one stamp are meant
FEW = 2  # irregular steps, which dropped or repeated rows may well make
MOST = 0.05  # share of the rows that a bus may have delivered together
MEANT = 0.5  # share of the stamps with such rows where the user says that they are meant


def evened_stamps(
    table: Table, outputs: Sequence[str], sidecar: Sidecar, trusted: bool = False
) -> Table:
    """Returns a table with even stamps where digits were all that they lost, which it tells.

    The table stays as it is where its stamps are even already, or uneven for another reason.
    """
    stamps, declared = _stamps(table), sidecar.sampling_time
    if stamps is None:
        return table
    if declared is not None:
        if fits(stamps.time, _width(stamps, declared), declared):
            return _with_step(table, stamps, declared)
    elif step := _proven_step(table, stamps, outputs, trusted):
        return _with_step(table, stamps, step)
    if stamps.is_coarse:
        _refuse_irregular(table, stamps, outputs, sidecar, trusted)
    return table


def refuse_contradicted(
    table: Table, outputs: Sequence[str], sidecar: Sidecar, trusted: bool = False
) -> None:
    """Refuse a declared sampling time where the stamps are even with another one."""
    declared = sidecar.sampling_time
    # Where most rows have empty cells, each channel has steps of its own.
    if declared is None or np.isnan(table.data).any(axis=1).mean() >= 0.5:
        return
    stamps = _stamps(table)
    proven = _proven_step(table, stamps, outputs, trusted) if stamps else None
    step = proven or _even_step(table)
    if not step or abs(declared - step) <= EXACT * step:  # such as that of two clocks
        return
    thin = " (a log is thinned by every = ... in the robot's file)" if declared > step else ""
    raise InputError(
        f"{sidecar.file_of('sampling_time')} says sampling_time = {declared:.6g}, and the stamps of"
        f" {table.path} are even with a step of {step:.6g} s; correct sampling_time or leave it"
        f" out{thin}"
    )


def _stamps(table: Table) -> Stamps | None:
    """Returns the stamps of a table as they are judged; None where they cannot be even."""
    time = table["time"]
    if len(time) < MIN_ROWS or not np.abs(time).max() < WHOLE:  # seconds are not told apart there
        return None
    if np.any(np.diff(time) < 0) or time[0] == time[-1]:
        return None
    return judged(time)


def _width(stamps: Stamps, declared: float) -> FloatArray:
    """Returns how far stamps may be off a declared grid [s], shape (n,): a whole quantum."""
    return stamps.quanta + JITTER * declared


def _proven_step(
    table: Table, stamps: Stamps, outputs: Sequence[str], trusted: bool
) -> float | None:
    """Returns the sampling time [s] of a log that only an even one can be, else None."""
    if stamps.steps is None:
        return None
    low, high = stamps.steps
    is_exact = high - low <= (MEANT_EXACT if trusted else EXACT) * high
    is_sure = is_exact and _is_proven(table, stamps, outputs, trusted)
    return _roundest(low, high) if is_sure else None


def _is_proven(table: Table, stamps: Stamps, outputs: Sequence[str], trusted: bool) -> bool:
    """Returns whether only an even log has such stamps, of which one step fits all.

    Rows that share stamps were sampled in their turn where an output moves on within these. If the
    user says that such rows are meant, then it is enough that no output stands still there.
    """
    same = shared(stamps.time)
    if same.any():
        moved = [moves_on(stamps.time, table[name]) for name in outputs]
        return (trusted and False not in moved) or True in moved
    if not stamps.is_coarse:
        return True
    odd = _odd(stamps.time)
    if odd.any() and np.diff(stamps.time)[odd].min() < np.median(np.diff(stamps.time)):
        return True  # no rows that are missing make steps narrower
    # If more than a few rows are missing by chance, hardly ever does one sampling time fit, but it
    # may where each n-th row is missing. The beat of a sampling time is seldom n to the row.
    apart = np.diff(np.flatnonzero(odd))
    return len(apart) > FEW and bool(np.ptp(apart))


def _odd(time: FloatArray) -> np.ndarray:
    """Returns which steps are neither zero nor the usual one, shape (n - 1,)."""
    steps = np.diff(time)
    usual = np.median(steps[steps > 0])
    return np.asarray((steps > 0) & (np.abs(steps - usual) > 0.25 * usual))


def _with_step(table: Table, stamps: Stamps, step: float) -> Table:
    data = table.data.copy()
    data[:, table.names.index("time")] = grid(stamps.time[0], step, len(data))
    return replace(table, data=data).told(
        f"Stamps of log {table.path.stem!r} are multiples of {stamps.tick:.6g} s; all its"
        f" rows were kept, and given the sampling time that fits them, {step:.6g} s"
        f" ({1 / step:.4g} Hz)."
    )


def _roundest(low: float, high: float) -> float:
    """Returns the step in an interval that has, or whose rate has, the fewest digits."""
    middle = (low + high) / 2
    for digits in range(1, 17):
        for step in (float(f"{middle:.{digits}g}"), 1 / float(f"{1 / middle:.{digits}g}")):
            if low <= step <= high:
                return step
    return middle


def _even_step(table: Table) -> float | None:
    """Returns the step [s] of stamps that are even by themselves, else None."""
    try:
        check_time(table["time"], table.place)
    except InputError:
        return None
    return sampling_time(table["time"])


def _refuse_irregular(
    table: Table, stamps: Stamps, outputs: Sequence[str], sidecar: Sidecar, trusted: bool
) -> None:
    """Refuse coarse stamps that merge rows, or make gaps, as no dropped or repeated rows do."""
    time, declared = stamps.time, sidecar.sampling_time
    same, odd = shared(time), _odd(time)
    lost = np.zeros(len(same), dtype=bool)
    for name in outputs:
        if moves_on(time, table[name]) is not False:
            lost |= same & (np.abs(np.diff(table[name])) > 0)
    n_lost, n_odd = int(lost.sum()), int(odd.sum())
    if n_lost + n_odd <= FEW or (declared and not n_lost):
        return
    if trusted and n_lost <= MEANT * int(np.sum(~same)):
        return
    # Rows that are missing by chance are no matter of digits: no step fits them. A few rows that
    # came together may be lost where the user says what the step is.
    if stamps.steps is None and n_lost <= (MOST * len(time) if declared else FEW):
        return
    refuse_stopped(table, sidecar)
    if declared:
        _refuse_missing(table, stamps, sidecar, declared)
    row = int(np.flatnonzero(lost if n_lost else odd)[0])
    shown = " and ".join(f"{t:.12g}" for t in time[row : row + 2])
    odd_ones = [
        f"{n_lost} rows have the stamp of the row before them and other values",
        f"{n_odd} steps are not the usual one",
    ]
    which_rows = " and ".join(t for t, n in zip(odd_ones, (n_lost, n_odd), strict=True) if n)
    which = "no sampling time fits all rows"
    cure = "write sampling_time = ... [s] into {file} if the rows are even"
    if declared:
        which = f"sampling_time = {declared:.6g} does not fit all rows"
        cure = "correct sampling_time in {file}"
        if stamps.steps:
            cure += " (each one from {:.6g} to {:.6g} s fits)".format(*stamps.steps)
    elif stamps.steps:
        low, high = stamps.steps
        which = f"each sampling time from {low:.6g} to {high:.6g} s fits all rows"
    raise InputError(
        f"{table.place(row)} and the row after it have the stamps {shown} s: stamps of log"
        f" {table.path.stem!r} are multiples of {stamps.tick:.6g} s, too coarse for rows"
        f" that come every {stamps.mean:.4g} s, where {which_rows}, and {which};"
        f" {cure.format(file=sidecar.file_of('sampling_time'))}, or record stamps with more digits"
    )


def _refuse_missing(table: Table, stamps: Stamps, sidecar: Sidecar, declared: float) -> None:
    """Refuse stamps that a declared step fits piece by piece, and tell where rows are missing."""
    loose = _width(stamps, declared)
    for width in (loose - stamps.quanta / 2, loose):
        if places := missing_rows(stamps.time, width, declared):
            (row, count), time = places[0], table["time"]
            is_sure = stamps.steps is None and len(places) <= FEW
            rest = len(places) - 1
            more = f", and in {rest} more place{'s' * (rest > 1)}" if rest else ""
            rows = "1 row is" if count == 1 else f"{count} rows are"
            cure = "" if is_sure else ", or correct sampling_time if no rows are missing"
            raise InputError(
                f"{table.place(row - 1)}: about {rows} missing behind it: sampling_time ="
                f" {declared:.6g} in {sidecar.file_of('sampling_time')} fits the rows up to"
                f" {time[row - 1]:.9g} s and those from {time[row]:.9g} s on, but not both at once"
                f"{more}; save the rows before and behind as two logs{cure}"
            )
