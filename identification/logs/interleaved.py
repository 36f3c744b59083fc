"""Rows of a second publisher at stamps of its clock, between the rows of the robot.

Such a row says that an input goes to another value and is back in the next row. A right log may say
the same, such as of a drive that is switched at each sample. So two proofs of a second clock count:

    its stamps      they are even, so are those of the other rows, and together they are not
    its outputs     they repeat the row before to the last digit, and in other rows they change
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import FloatArray
from identification.logs.table import Table

FEWEST = 20  # rows that show a clock
EVEN = 0.3  # of an interval, by which rows of one clock may be late or early
NEARLY = 0.9  # of the rows, that have to be as a second publisher writes them
MIDDLE = 0.1  # of an interval about its middle: rows there may be those of one faster clock
CHANCE = 1e-9  # that outputs of the robot would repeat in all these rows, and only there


def refuse_interleaved(
    table: Table, inputs: Sequence[str], outputs: Sequence[str], overrule: str
) -> None:
    """Refuse rows of a second publisher, at other stamps than those of the robot."""
    if not inputs or not outputs:
        return
    u, y = (np.column_stack([table[n] for n in names]) for names in (inputs, outputs))
    rows = np.flatnonzero(np.isfinite(u).all(axis=1) & np.isfinite(y).all(axis=1))
    t, u, y = table["time"][rows], u[rows], y[rows]
    if len(t) < 3 * FEWEST or np.any(np.diff(t) <= 0):
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
    if int(alone.sum()) >= FEWEST:
        values, counts = np.unique(u[alone], axis=0, return_counts=True)
        for k in np.argsort(-counts, kind="stable")[:2]:  # a course of one value is one of the two
            if counts[k] >= FEWEST:
                yield alone & (u == values[k]).all(axis=1)
    away = np.append(False, np.abs(np.diff(u, axis=0)).sum(axis=1))
    across = np.zeros(len(u))
    across[1:-1] = np.abs(u[2:] - u[:-2]).sum(axis=1)
    odd = alone & (across < np.minimum(away, np.append(away[1:], 0.0)))
    changed = repeats & differs
    if int(odd.sum()) >= FEWEST and np.sum(odd & changed) >= NEARLY * np.sum(changed):
        yield odd & repeats


def _is_clock(t: FloatArray) -> bool:
    """Returns whether stamps [s] are even but for stamps that are missing."""
    if len(t) < FEWEST:
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
    is_by_chance = changes * np.log1p(-share) >= np.log(CHANCE)
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
