"""Rows that share a stamp: written twice, sampled twice, or stamped by a clock that is too slow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from identification.logs.sampling import FloatArray
from identification.logs.table import Table

SURE = 4.0  # std of a sum of products that noise alone makes
ALIKE = (0.5, 2.0)  # of the motion between stamps, that there is within them, if both are one step
STILL = 0.25  # of the motion between stamps, below which there is none within them


def shared(time: FloatArray) -> np.ndarray:
    """Returns which rows but the first have the stamp of the row before them, shape (n - 1,).

    Args:
        time: stamps, shape (n,) [s].
    """
    return np.asarray(time[1:] == time[:-1])


def without_repeated(table: Table) -> tuple[Table, str]:
    """Returns a table without rows that were written twice, and a sentence that tells them.

    Returns:
        The table as it is and "" where no row shares its stamp with the row before it, or where one
        that does has another cell: then rows may have been sampled in one tick of a clock.
    """
    before, after = table.data[:-1], table.data[1:]
    equal = ((before == after) | (np.isnan(before) & np.isnan(after))).all(axis=1)
    same = shared(table["time"])
    if not same.any() or not equal[same].all():
        return table, ""
    keep = np.flatnonzero(np.append(True, ~same))
    said = (
        f"{int(same.sum())} rows of log {table.path.stem!r} repeat the row before them to the last"
        " digit and were left out."
    )
    return replace(table, data=table.data[keep], place=_place(table.place, keep)), said


def _place(place: Callable[[int], str], keep: np.ndarray) -> Callable[[int], str]:
    return lambda row: place(int(keep[row]))


def moves_on(time: FloatArray, x: FloatArray) -> bool | None:
    """Returns whether a channel goes on between rows of one stamp as it does between stamps.

        β = ⟨d s⟩,  d_k = x_{k+1} - x_k,  s_k = x_{k+2} - x_{k-1}

    d and s have no sample in common, so that noise adds nothing to the mean of their products. It
    is as large within stamps as between them where all rows are one step apart, and zero within
    them where a stamp was read twice.

    Args:
        time: stamps, shape (n,) [s].
        x: a channel, shape (n,); NaN where nothing stands.

    Returns:
        None where noise hides it, or where the motion within stamps is another one.
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
