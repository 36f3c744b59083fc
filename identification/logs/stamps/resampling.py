"""A log with uneven time stamps or missing cells, put on an even grid.

    h     the median interval of an output's own samples, the largest of all outputs
    y_k   the monotone cubic (Fritsch, Carlson 1980) through the samples of y, at t_k = t_0 + k h
    u_k   hold "zoh": mean of the held input over [t_k, t_k + h), so that it does the same work
          hold "foh": the straight line between the nearest samples, at t_k

Each channel has the rows in which it is finite; of equal stamps the last row counts. What stands
in a gap is made up; `identification.logs.stamps.gaps` says where this does harm. `on_a_grid` does
less: it draws a straight line between the samples of a channel, and refuses a gap that is too wide
for it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.errors import InputError
from identification.logs.names import quoted
from identification.logs.sampling import MIN_ROWS, FloatArray, grid
from identification.logs.stamps.gaps import Channel, Gap, find_gaps, find_lost_rows, find_pauses
from identification.logs.table import Table

EVEN = 1e-3  # of an interval, by which even stamps may differ
MOST_PER_ROW = 100  # samples of a grid: of more all but a hundredth would be made up
ROUND = 0.02  # of the rate, by which it may be rounded: any rate near the samples' own would do


def even_out(
    table: Table, inputs: Sequence[str], hold: str, step: float | None = None
) -> tuple[Table, tuple[tuple[float, float], ...]]:
    """Put the columns of a table on an even grid.

    Args:
        table: its stamps are finite, none smaller than the one before; NaN where nothing arrived.
        inputs: which of its columns are inputs.
        hold: of the inputs, "zoh" or "foh".
        step: of the grid [s]; the median interval when None.

    Returns:
        The table on the grid, which tells what was done, and begin and end of each gap over which
        samples may be wrong [s].
    """
    name, time = table.path.stem, table["time"]
    channels = {n: table[n] for n in table.names if n != "time"}
    back = np.flatnonzero(np.diff(time) < 0)
    if back.size:
        at = time[back[0]]
        raise InputError(
            f"time of log {name!r} goes back after {at:.9g} s; sort its rows, or cut the log there"
        )
    sampled = [_samples(name, key, time, values) for key, values in channels.items()]
    # An input that is held may come as seldom as it changes.
    timed = [c for c in sampled if c.name not in inputs or hold == "foh"] or sampled
    h = step or _round(max(float(np.median(np.diff(c.time))) for c in timed))
    begin, end = max(c.time[0] for c in sampled), min(c.time[-1] for c in timed)
    steps = float(end - begin) / float(h)
    if steps > MOST_PER_ROW * len(time):
        raise InputError(
            f"log {name!r} has {len(time)} rows in {end - begin:.6g} s, and a grid of {h:.3g} s"
            f" would have {steps:.3g}, of which nearly all were made up; see whether all stamps"
            " have one unit, and give sampling_time where the usual step is another one"
        )
    n = int(steps + 1e-6) + 1
    if n < MIN_ROWS:
        raise InputError(
            f"the channels of log {name!r} overlap for {max(0.0, end - begin):.3g} s only, fewer"
            f" than {MIN_ROWS} samples; leave out the one that begins late or ends early"
        )
    t = grid(begin, h, n)
    out = {c.name: _held(c, t, h) if c.name in inputs and hold == "zoh" else
           np.interp(t, c.time, c.values) if c.name in inputs else
           _smooth(c, t) for c in sampled}  # fmt: skip
    # An input that usually comes with every sample was not held where it did not come.
    names = {c.name for c in timed}
    steady = [c for c in sampled if c.name not in names and np.median(np.diff(c.time)) < 1.5 * h]
    gaps = [gap for c in timed for gap in find_gaps(name, c, out[c.name], h)]
    gaps += [gap for c in steady for gap in find_pauses(name, c, n, h)]
    gaps += [gap for c in steady for gap in find_lost_rows(c, time)]
    why = _why(time, channels)
    text = _sentence(name, why, [*timed, *steady], t, h) + _shared_sentence(time, channels)
    text += _gaps_sentence(gaps)
    even = Table(
        table.path, ("time", *out), np.column_stack([t, *out.values()]),
        lambda row: f"sample {row + 1} of the grid of {table.path}", remarks=table.remarks,
    )  # fmt: skip
    return even.told(text), tuple(dict.fromkeys((gap.begin, gap.end) for gap in gaps))


def on_a_grid(
    time: FloatArray,
    channels: Mapping[str, FloatArray],
    step: float,
    widest: float,
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Interpolate every channel, from the time when all have begun to the time when one ends.

    Args:
        time: time stamps, shape (n,) [s]; rows with equal stamps are adjacent.
        channels: by name, shape (n,), each in a unit of its own; NaN where nothing arrived.
        step: step of the grid [s].
        widest: largest gap between two samples of a channel that is interpolated [s].

    Returns:
        Time of the grid from zero, shape (m,) [s], and the channels on it.

    Raises:
        InputError: a channel has fewer than two samples or too wide a gap, or nothing is left.
    """
    if not (step > 0 and np.isfinite(step)):
        raise InputError(f"a grid needs a positive step, not {step:g} s")
    seen = {name: np.isfinite(x) & np.isfinite(time) for name, x in channels.items()}
    for name, rows in seen.items():
        if rows.sum() < 2:
            raise InputError(f"channel {name!r} has {rows.sum()} samples; leave it out")
    order = np.argsort(time, kind="stable")
    begin = max(float(time[rows].min()) for rows in seen.values())
    end = min(float(time[rows].max()) for rows in seen.values())
    if end - begin < 2 * step:
        raise InputError("no three steps in which every channel was measured; leave one out")
    t = grid(begin, step, int((end - begin) / step + 1e-9) + 1)
    out = {}
    for name, x in channels.items():
        at = order[seen[name][order]]
        inside = (time[at] >= begin) & (time[at] <= end)
        gaps = np.diff(time[at][inside])
        if len(gaps) and gaps.max() > widest:
            k = int(gaps.argmax())
            raise InputError(
                f"channel {name!r} has no sample for {gaps[k]:.3g} s from"
                f" {time[at][inside][k]:.6g} s, more than {widest:g} s; cut the log there"
            )
        out[name] = np.interp(t, time[at], x[at])
    return t - begin, out


def _samples(log: str, name: str, time: FloatArray, values: FloatArray) -> Channel:
    """Returns the rows of a channel in which it is finite, the last of equal stamps."""
    rows = np.flatnonzero(np.isfinite(values))
    rows = rows[np.append(np.diff(time[rows]) > 0, True)] if rows.size else rows
    if rows.size < MIN_ROWS:
        has = "1 sample" if rows.size == 1 else f"{rows.size} samples"
        raise InputError(
            f"column {quoted(name)} of log {log!r} has {has} and needs {MIN_ROWS};"
            " leave it out, or record again"
        )
    return Channel(name, time[rows], values[rows])


def _round(interval: float) -> float:
    """Returns the interval near this one whose rate [Hz] has the fewest digits."""
    rate = 1 / interval
    rounded = (float(f"{rate:.{digits}g}") for digits in range(1, 17))
    return 1 / next((r for r in rounded if abs(r - rate) <= ROUND * rate), rate)


def _held(c: Channel, t: FloatArray, h: float) -> FloatArray:
    """Returns the means of a held input over the intervals of a grid."""
    stamps = np.append(c.time, max(t[-1] + h, c.time[-1]) + h)
    work = np.concatenate([[0.0], np.cumsum(c.values * np.diff(stamps))])
    return np.asarray((np.interp(t + h, stamps, work) - np.interp(t, stamps, work)) / h)


def _smooth(c: Channel, t: FloatArray) -> FloatArray:
    """Returns an output on a grid, by cubics that keep its rises and falls."""
    # A rate is a harmonic mean of slopes, (w_1 + w_2) / (w_1/m_1 + w_2/m_2): a slope of 1e-318
    # makes the sum infinite and the mean zero, as it should be.
    with np.errstate(over="ignore"):
        from scipy.interpolate import PchipInterpolator  # slow to import

        return np.asarray(PchipInterpolator(c.time, c.values)(t))


def _why(time: FloatArray, channels: Mapping[str, FloatArray]) -> str:
    """Says why a log needs another grid: its stamps, or empty cells."""
    gaps = np.diff(time)
    empty = sum(int(np.isnan(x).sum()) for x in channels.values())
    if empty and gaps.max() - gaps.min() <= EVEN * gaps.max():
        return f"has {empty} empty cell{'s' * (empty > 1)}"
    return "is uneven in time" + (f", with {empty} empty cells," if empty else "")


def _shared_sentence(time: FloatArray, channels: Mapping[str, FloatArray]) -> str:
    """Tells of rows that do not count because another one has their stamp; "" where none has."""
    lost = np.zeros(len(time), dtype=bool)
    for x in channels.values():
        rows = np.flatnonzero(np.isfinite(x))
        lost[rows[:-1][np.diff(time[rows]) == 0]] = True
    n = int(lost.sum())
    if not n:
        return ""
    return (
        f" {n} row{'s have' if n > 1 else ' has'} the stamp of another one, and the last of each"
        " counts."
    )


def _gaps_sentence(gaps: Sequence[Gap]) -> str:
    """Tells of the gaps over which what was made up may be wrong; "" where there is none."""
    if not gaps:
        return ""
    worst = max(gaps, key=lambda gap: gap.end - gap.begin)
    spans = len({(gap.begin, gap.end) for gap in gaps})
    many = "1 gap is" if spans == 1 else f"{spans} gaps are"
    return (
        f" {many} too wide to be bridged ({'the widest ' if spans > 1 else ''}{worst.why});"
        " windows of a horizon that touch a gap are left out, if gaps are not trusted."
    )


def _sentence(log: str, why: str, timed: Sequence[Channel], t: FloatArray, h: float) -> str:
    made, widest, at = 0, 0.0, 0.0
    for c in timed:
        near = np.clip(np.searchsorted(c.time, t), 1, len(c.time) - 1)
        apart = np.minimum(np.abs(t - c.time[near - 1]), np.abs(t - c.time[near]))
        made = max(made, int(np.sum(apart > 0.5 * h * (1 + 1e-6))))
        k = int(np.argmax(np.diff(c.time)))
        if c.time[k + 1] - c.time[k] > widest:
            widest, at = float(c.time[k + 1] - c.time[k]), float(c.time[k])
    return (
        f"Log {log!r} {why} and was put on a grid of {h:.6g} s ({1 / h:.4g} Hz); its"
        f" largest gap is {widest:.3g} s, from {at:.6g} s, and {made} of {len(t)} samples were made"
        " up, because nothing was measured within half a step of them."
    )
