"""Gaps of a log: where nothing was measured, and where what is made up there does harm.

A gap of n intervals is bridged if the log itself says that this is harmless: where the samples are
there, the middle of n intervals is compared with the straight line across them. An error below the
noise, below a step of the encoder, or below a hundredth of the motion, changes no fit. Another gap
costs what touches it: over a horizon those windows are left out (`identification.windows.windows`).

A held input is judged otherwise, because a line says nothing of it: a row that is lost is a gap if
the input may have changed in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.logs.noise import encoder_step, noise_floor
from identification.logs.plausible import stands_still
from identification.logs.sampling import FloatArray

ALLOWED = 0.01  # of a channel's motion, that the bridge of a gap may err by
CLEAR = 2.0  # std of its noise, that it may err by
HELD = 10.0  # intervals that an input may stay away and count as held, if it comes every interval
WHOLE, NEARLY = 0.25, 0.9  # of an interval, by which so many rows of an even log are off at most
RUN = 5  # wide intervals in a row that are another sampling time
SELDOM = 0.1  # of the rows, in which an input changes: to change and return within two is rarer
# Of the rows, that may be lost. With 10 of 2000 lost a fit erred by 2 to 7 % (3 to 5 std), because
# an input that changes with each sample moves its joint little more than a few wrong samples do.
LOST = 1e-3
MOST = 0.05  # of the log, that one gap may be: beyond it the rest of the log is no witness


@dataclass(frozen=True)
class Channel:
    """The samples of one channel, stamps (m,) [s] increasing."""

    name: str
    time: FloatArray
    values: FloatArray


@dataclass(frozen=True)
class Gap:
    """A gap over which what is made up may be wrong."""

    begin: float  # the last stamp before it [s]
    end: float  # the first stamp behind it [s]
    why: str  # what is missing, and how far a bridge of it errs, in words


def find_gaps(log: str, c: Channel, y: FloatArray, h: float) -> Iterator[Gap]:
    """Finds the gaps that a straight line would bridge badly, by what it does elsewhere in the log.

    The channel comes with every sample of the grid, whose step is h [s]; y is the channel on it,
    (n,).
    """
    intervals = np.rint(np.diff(c.time) / h).astype(int)
    wide = np.flatnonzero(intervals > 1)
    if not wide.size or stands_still(c.values):
        return
    _refuse_longest(log, c, len(y), h)
    noise = float(noise_floor(y[:, None])[0])
    allowed = max(ALLOWED * float(np.ptp(y)), CLEAR * noise, encoder_step(c.values))
    errors = {n: _bridging_error(y, n) for n in np.unique(intervals[wide]).tolist()}
    for k in wide.tolist():
        error = errors[int(intervals[k])]
        if error > allowed:
            errs = (
                "a straight line over a gap of this length would err by"
                f" {error:.2g} elsewhere in the log (allowed: {allowed:.2g})"
            )
            yield Gap(float(c.time[k]), float(c.time[k + 1]), f"{_missing(c, k)}, and {errs}")


def find_pauses(log: str, c: Channel, n: int, h: float) -> Iterator[Gap]:
    """Finds where a held input stays away for long though it usually comes with every sample.

    The grid has n samples and the step h [s].
    """
    for k in np.flatnonzero(np.diff(c.time) > HELD * h).tolist():
        _refuse_longest(log, c, n, h)
        yield Gap(float(c.time[k]), float(c.time[k + 1]),
                  f"{_missing(c, k)}, though it usually comes with every sample")  # fmt: skip


def find_lost_rows(c: Channel, time: FloatArray) -> list[Gap]:
    """Finds the rows that an even log has lost while a held input may have changed.

    What the input was in such a row is not known, and acts on all that follows. It is known where
    the input is the same on both sides and seldom changes from row to row. The stamps of the rows,
    shape (n,) [s], are none smaller than the one before. There is no gap where the rows are not
    even, or so few are lost that a fit does not feel it.
    """
    rows = np.unique(time)
    apart = np.diff(rows) / np.median(np.diff(rows))
    counts = np.rint(apart)
    if np.mean(np.abs(apart - counts) <= WHOLE) < NEARLY:
        return []  # none can be counted between rows that do not come evenly
    # Many wide intervals in a row are another sampling time, and nothing is lost there.
    edges = np.concatenate([[0], np.flatnonzero(np.diff(counts)) + 1, [len(counts)]])
    run = np.repeat(np.diff(edges), np.diff(edges))
    has = np.isin(rows, c.time)
    wide = np.flatnonzero((counts > 1) & (run < RUN) & has[:-1] & has[1:])
    at = np.searchsorted(c.time, rows[wide])
    changes = np.abs(np.diff(c.values)) > ALLOWED * float(np.ptp(c.values))
    is_held = np.mean(np.delete(changes, at)) <= SELDOM if len(at) < len(changes) else False
    unknown = wide[changes[at]] if is_held else wide[: len(wide) if changes.any() else 0]
    lost = int(counts[unknown].sum()) - len(unknown)
    total = int(counts.sum()) + 1
    if lost <= LOST * total:
        return []
    return [Gap(float(rows[k]), float(rows[k + 1]),
                f"no row for {rows[k + 1] - rows[k]:.3g} s from {rows[k]:.6g} s, and {lost} of"
                f" {total} rows are missing where {c.name} may have changed")
            for k in unknown.tolist()]  # fmt: skip


def _bridging_error(y: FloatArray, n: int) -> float:
    """Computes the rms error of lines across n intervals in their middle."""
    m = n // 2
    line = y[:-n] + m / n * (y[n:] - y[:-n])
    return float(np.sqrt(np.mean((y[m : len(y) - n + m] - line) ** 2)))


def _missing(c: Channel, k: int) -> str:
    return f"no {c.name} for {c.time[k + 1] - c.time[k]:.3g} s from {c.time[k]:.6g} s"


def _refuse_longest(log: str, c: Channel, n: int, h: float) -> None:
    """Refuse a channel whose longest gap is too large a part of a log of n samples."""
    gaps = np.diff(c.time)
    k = int(np.argmax(gaps))
    if round(float(gaps[k]) / h) > max(2, MOST * n):
        raise InputError(
            f"log {log!r} has {_missing(c, k)}, more than {100 * MOST:g} % of it, and says nothing"
            " of what was there; save the rows before the gap and those behind it as two logs, and"
            " give both or the longer one"
        )
