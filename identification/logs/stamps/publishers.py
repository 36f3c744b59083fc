"""Rows of a second publisher between those of a robot: with its stamps, of zeros, or on a clock.

A joint that is watched moves by at most m between rows. It cannot be at two places at one time
that are farther apart than that, and it cannot go from far away to zero and back within a sample.
Only positions are judged so: a rate may jump, and so may a command. What is smaller than the noise,
a few steps of an encoder or a hundredth of the motion is not judged, because it changes no fit.

A row at a stamp of its own says that an input goes to another value and is back in the next row. A
right log may say the same, such as of a drive that is switched at each sample. So two proofs of a
second clock count:

    its stamps      they are even, so are those of the other rows, and together they are not
    its outputs     they repeat the row before to the last digit, and in other rows they change
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from identification.errors import InputError
from identification.logs.noise import encoder_step, noise_floor
from identification.logs.plausible import STEPS
from identification.logs.sampling import FloatArray
from identification.logs.stamps.gaps import ALLOWED
from identification.logs.table import Table

CLOCK_ROWS = 20  # rows that show a clock
EVEN = 0.3  # of an interval, by which rows of one clock may be late or early
NEARLY = 0.9  # of the rows, that have to be as a second publisher writes them
MIDDLE = 0.1  # of an interval about its middle: rows there may be those of one faster clock
LUCK = 1e-9  # that outputs of the robot would repeat in all these rows, and only there
BEYOND = 2.0  # times the farthest motion between rows, from which a distance contradicts it
NOISE = 10.0  # std of the noise, which two samples of 10^6 do not differ by
FEWEST = 4  # rows, or stamps, that show how a joint moves
SAME = 1e-3  # of the mean interval: stamps so near each other are one, as they are printed
USUAL = 1.5  # of the usual interval: rows so near each other have none missing between them
SINGLE = 2.5  # of the usual interval, that two rows with one between them are apart
VARIED = 4.0  # times the farthest motion, that the places vary by from which it goes to zero
CHANCE = 0.05  # of the rows, that may give an input two values at one time by chance
# Of the stamps: if more have rows that contradict each other, no trust tells which counts.
MOST = 0.5
UNTOLD = ", for no trust in rows tells which of them count"
RATES = ("rad/s", "m/s")


def refuse_second_publisher(
    table: Table,
    inputs: Sequence[str],
    outputs: Sequence[str],
    units: Mapping[str, str],
    overrule: str,
    trusted: bool = False,
) -> None:
    """Refuse rows that are not of the robot whose other rows the log has."""
    positions = [name for name in outputs if units.get(name) not in RATES]
    for name in positions:
        _refuse_twice(table, name, units.get(name, ""), overrule, trusted)
    if trusted:
        return
    zero = np.flatnonzero(_zero_rows(table, inputs, outputs))
    if zero.size:
        for name in positions:
            _refuse_zeros(table, name, zero, units.get(name, ""), overrule)


def refuse_two_inputs(
    table: Table, inputs: Sequence[str], overrule: str, trusted: bool = False
) -> None:
    """Refuse inputs with two values at one time, of which only one can be kept.

    A step that is written as its two values at one time is right: its first value is the one that
    held before.
    """
    for name in inputs:
        rows, u, t = _seen(table, name)
        same = np.append(False, t[1:] == t[:-1])
        first = np.maximum.accumulate(np.where(same, 0, np.arange(len(t))))  # of each stamp's rows
        is_step = u[first] == u[np.maximum(first - 1, 0)]
        bad = np.flatnonzero(same & (u != np.roll(u, 1)) & ~is_step)
        if len(bad) > (MOST * int(np.sum(~same)) if trusted else CHANCE * len(t)):
            k = int(bad[0])
            raise InputError(
                f"{table.place(int(rows[k]))}: there are two rows with one stamp, {t[k]:.9g} s, in"
                f" which {name} is {u[k - 1]:.4g} and {u[k]:.4g}{_more(len(bad), 'pair')}, and"
                " nothing says which of them the robot had; keep the rows of one publisher"
                + (UNTOLD if trusted else overrule)
            )


def refuse_interleaved(
    table: Table, inputs: Sequence[str], outputs: Sequence[str], overrule: str
) -> None:
    """Refuse rows of a second publisher, at other stamps than those of the robot."""
    if not inputs or not outputs:
        return
    u, y = (np.column_stack([table[n] for n in names]) for names in (inputs, outputs))
    rows = np.flatnonzero(np.isfinite(u).all(axis=1) & np.isfinite(y).all(axis=1))
    t, u, y = table["time"][rows], u[rows], y[rows]
    if len(t) < 3 * CLOCK_ROWS or np.any(np.diff(t) <= 0):
        return
    repeats = np.append(False, (y[1:] == y[:-1]).all(axis=1))
    for second in _suspects(u, repeats):
        if np.any(second[1:] & second[:-1]) or not _is_clock(t[second]):
            continue
        proof = _proof(t, second, repeats)
        if proof:
            k = int(np.flatnonzero(second)[0])
            name, j = next((n, j) for j, n in enumerate(inputs) if u[k, j] != u[k - 1, j])
            raise InputError(
                f"{table.place(int(rows[k]))} is one of {int(second.sum())} rows that come on a"
                f" clock of their own, every {np.median(np.diff(t[second])):.3g} s, as of a second"
                f" publisher: {name} is {u[k, j]:.4g} in it, {u[k - 1, j]:.4g} in the row before"
                f" and {u[k + 1, j]:.4g} in the row behind, and {proof}; keep the rows of one"
                f" publisher{overrule}"
            )


def _suspects(u: FloatArray, repeats: np.ndarray) -> Iterator[np.ndarray]:
    """Yields rows, shape (n,), between which and both their neighbours the inputs go and return."""
    differs = np.append(False, (u[1:] != u[:-1]).any(axis=1))
    alone = differs & np.append(differs[1:], False)
    if int(alone.sum()) >= CLOCK_ROWS:
        values, counts = np.unique(u[alone], axis=0, return_counts=True)
        for k in np.argsort(-counts, kind="stable")[:2]:  # a course of one value is one of the two
            if counts[k] >= CLOCK_ROWS:
                yield alone & (u == values[k]).all(axis=1)
    away = np.append(False, np.abs(np.diff(u, axis=0)).sum(axis=1))
    across = np.zeros(len(u))
    across[1:-1] = np.abs(u[2:] - u[:-2]).sum(axis=1)
    odd = alone & (across < np.minimum(away, np.append(away[1:], 0.0)))
    changed = repeats & differs
    if int(odd.sum()) >= CLOCK_ROWS and np.sum(odd & changed) >= NEARLY * np.sum(changed):
        yield odd & repeats


def _is_clock(t: FloatArray) -> bool:
    """Returns whether stamps [s] are even but for stamps that are missing."""
    if len(t) < CLOCK_ROWS:
        return False
    apart = np.diff(t)
    step = float(np.median(apart))
    counts = np.maximum(np.rint(apart / step), 1.0)
    place = np.append(0.0, np.cumsum(counts))
    off = t - np.polyval(np.polyfit(place, t, 1), place)
    return bool(np.mean(np.abs(off) <= EVEN * step) >= NEARLY)


def _proof(t: FloatArray, second: np.ndarray, repeats: np.ndarray) -> str:
    """Returns what proves that some rows are of a second publisher, in words; "" if nothing."""
    changes, share = int(np.sum(~repeats[1:])), float(second.mean())
    is_by_chance = changes * np.log1p(-share) >= np.log(LUCK)
    if repeats[second].all() and not is_by_chance:
        return "the outputs repeat the row before to the last digit"
    first = t[~second]
    usual = float(np.median(np.diff(first)))
    if np.mean(np.diff(first) > (1 + 2 * EVEN) * usual) > 1 - NEARLY or not _is_clock(first):
        return ""  # without them the log has holes
    at = np.searchsorted(first, t[second])
    inside = (at > 0) & (at < len(first))
    before, after = first[at[inside] - 1], first[at[inside]]
    phase = (t[second][inside] - before) / (after - before)
    # Half a row behind each row they may be of one faster clock, and so if that has holes.
    is_one = 1.5 * float(np.median(np.diff(t))) < usual
    if is_one and abs(float(np.median(phase)) - 0.5) < MIDDLE:
        return ""
    return "without such rows the stamps are even"


def _refuse_twice(table: Table, name: str, unit: str, overrule: str, trusted: bool) -> None:
    """Refuse two rows with one stamp between which an output goes farther than it ever moves."""
    rows, x, t = _seen(table, name)
    if len(t) < FEWEST:
        return
    is_same = np.abs(np.diff(t)) <= SAME * (t[-1] - t[0]) / (len(t) - 1)
    same, first = np.flatnonzero(is_same), np.flatnonzero(np.append(True, ~is_same))
    if not same.size or len(first) < FEWEST:
        return
    last = np.append(first[1:], len(x)) - 1
    # Whatever rows of three stamps in a row are chosen, the joint moves at least so far.
    ends = [np.minimum.reduceat(x, first), np.maximum.reduceat(x, first)]
    least = [np.ptp([a[:-2], b[1:-1], c[2:]], axis=0) for a, b, c in product(ends, repeat=3)]
    moved = float(np.min(least, axis=0).max())
    # Each publisher's rows by themselves are no rougher than the robot.
    alone = (*ends, x[first], x[last])
    noise = min(float(noise_floor(y[:, None])[0]) for y in alone)
    encoder = min(map(encoder_step, alone))
    least_judged = max(NOISE * noise, STEPS * encoder, ALLOWED * float(np.ptp(x)))
    bad = same[np.abs(x[same + 1] - x[same]) > max(BEYOND * moved, least_judged)]
    between = "between such stamps"
    if not bad.size:
        between = "from row to row elsewhere"
        bad, moved = _there_and_back(x, is_same, least_judged)
    if len(bad) > (MOST * len(first) if trusted else 0):
        k = int(bad[0])
        raise InputError(
            f"{table.place(int(rows[k + 1]))}: there are two rows with one stamp, {t[k]:.9g} s, and"
            f" they contradict each other: {name} is {x[k]:.4g} and {x[k + 1]:.4g} {unit}".rstrip()
            + f", though it moves by {moved:.2g} at most {between}"
            f"{_more(len(bad), 'pair')}; keep the rows of one publisher"
            + (UNTOLD if trusted else overrule)
        )


def _there_and_back(x: FloatArray, is_same: np.ndarray, least: float) -> tuple[np.ndarray, float]:
    """Returns pairs of rows with one stamp, in one of which alone an output is somewhere else.

    Such a pair stands among rows with stamps of their own, and without one of its two rows the
    output moves there as it does in the rest of the log. So much is known of how it moves only
    where most stamps have one row. A distance is judged where it exceeds `least`; `is_same` says of
    each row but the first whether it has the stamp of the row before it, shape (n - 1,).

    Returns:
        The first row of each such pair, and how far the output moves at most between other rows.
    """
    none = np.array([], dtype=int)
    alone = ~np.append(False, is_same) & ~np.append(is_same, False)
    steps = np.abs(np.diff(x))[alone[1:] & alone[:-1]]
    if len(steps) <= MOST * float(np.sum(~is_same)):
        return none, 0.0
    step = float(steps.max())
    k = np.flatnonzero(is_same[1:-1] & alone[:-3] & alone[3:]) + 1
    near = [np.abs(x[a] - x[b]) <= step
            for a, b in ((k, k - 1), (k + 2, k), (k + 1, k - 1), (k + 2, k + 1))]  # fmt: skip
    is_far = np.abs(x[k + 1] - x[k]) > max(BEYOND * step, least)
    return k[is_far & (near[0] & near[1] | near[2] & near[3])], step


def _refuse_zeros(table: Table, name: str, zero: np.ndarray, unit: str, overrule: str) -> None:
    """Refuse rows of zeros, for which an output would have to go far and back in no time."""
    rows, x, t = _seen(table, name)
    kept = np.flatnonzero(~np.isin(rows, zero))
    if len(kept) < FEWEST:
        return
    moved = float(np.abs(np.diff(x[kept])).max())
    usual = float(np.median(np.diff(t[kept])))
    far = max(BEYOND * moved, STEPS * encoder_step(x), ALLOWED * float(np.ptp(x)))
    after = np.searchsorted(kept, np.flatnonzero(np.isin(rows, zero)))
    inside = (after > 0) & (after < len(kept))
    between = np.flatnonzero(np.isin(rows, zero))[inside]
    before, behind = kept[after[inside] - 1], kept[after[inside]]
    apart = np.minimum(np.abs(x[before]), np.abs(x[behind])) > far
    lasting = t[behind] - t[before]
    # A robot may step to zero and rest for a sample, always from the same few places.
    places = np.concatenate([x[before[apart]], x[behind[apart]]])
    is_varied = bool(places.size) and float(np.ptp(places)) > VARIED * moved
    bad = between[apart & (lasting <= (SINGLE if is_varied else USUAL) * usual)]
    if bad.size:
        k = int(np.flatnonzero(between == bad[0])[0])
        raise InputError(
            f"{table.place(int(rows[bad[0]]))} is zero in all columns, as of a second publisher:"
            f" {name} is {x[before[k]]:.4g} before it and {x[behind[k]]:.4g} {unit}".rstrip()
            + f" behind it, and moves by {moved:.2g} at most between other rows"
            f"{_more(len(bad), 'row', zero)}; drop such rows{overrule}"
        )


def _seen(table: Table, name: str) -> tuple[np.ndarray, FloatArray, FloatArray]:
    """Returns the rows in which a column has a number, these numbers, and their stamps."""
    rows = np.flatnonzero(np.isfinite(table[name]))
    return rows, table[name][rows], table["time"][rows]


def _zero_rows(table: Table, inputs: Sequence[str], outputs: Sequence[str]) -> np.ndarray:
    """Returns which rows have an output, and only zeros in all cells that are not empty: (n,)."""
    cells = np.column_stack([table[name] for name in (*inputs, *outputs)])
    empty = np.isnan(cells)
    return np.asarray((empty | (cells == 0)).all(axis=1) & ~empty[:, len(inputs) :].all(axis=1))


def _more(count: int, what: str, rows: np.ndarray | None = None) -> str:
    """Says how many such rows there are, and whether they come regularly."""
    steps = set() if rows is None else set(np.diff(rows).tolist())
    each = f", each {steps.pop()}th row of the log" if len(steps) == 1 and steps != {1} else ""
    return f" ({count} such {what}s{each})" if count > 1 else ""
