"""Arrays of a file as columns of numbers: one column each, or one for each entry of a vector.

q        shape (n,)      the column q
q        shape (n, 3)    the columns q_1, q_2 and q_3, or q.NAME where the entries have names

An archive of numpy is such a file.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.logs.names import listed
from identification.logs.sampling import FloatArray, grid
from identification.logs.stamps.stamps import WHOLE
from identification.logs.table import Table
from identification.storage.files import read_archive

KINDS = "biufm M".replace(" ", "")  # numbers, truths and times of numpy


def names_of(name: str, width: int, labels: Sequence[str] = ()) -> tuple[str, ...]:
    """Returns the names of the columns of vectors of some width, 0 for plain numbers.

    Their entries are called by their labels, or counted from 1 where there are not as many labels.
    """
    if not width:
        return (name,)
    if len(labels) == width:
        return tuple(f"{name}.{label}" for label in labels)
    return tuple(f"{name}_{k + 1}" for k in range(width)) if width > 1 else (name,)


def as_numbers(values: np.ndarray, is_stamp: bool) -> FloatArray:
    """Returns numbers (n,) as floats; dates [s] and stamps beyond a float count from the first."""
    if values.dtype.kind in "mM":
        ns = values.astype(f"{values.dtype.kind}8[ns]").astype(np.int64)
        return np.asarray((ns - ns[:1]) * 1e-9, np.float64)
    if is_stamp and values.dtype.kind in "iu" and values.size and np.abs(values).max() >= WHOLE:
        return np.asarray(values.astype(np.int64) - np.int64(values[0]), np.float64)
    return values.astype(np.float64)


def table_of(
    path: Path,
    columns: Mapping[str, Callable[[], np.ndarray]],
    wanted: Callable[[Sequence[str]], Collection[str]] | None,
    stamps: Collection[str],
    place: Callable[[int], str],
) -> Table:
    """Returns the wanted columns of a file as a table; all where nothing says which are wanted.

    Each column is given by what reads it, shape (n,) with the same n for all, `stamps` are those of
    time, and `place` says in words where a row stands.
    """
    asked = columns if wanted is None else wanted([*columns])
    names = tuple(name for name in columns if name in asked)
    data = [as_numbers(columns[name](), name in stamps) for name in names]
    if columns and not names:  # the refusal of what is missing lists those that are there
        data = [np.zeros(0)]
    if not columns or (names and not len(data[0])):
        raise InputError(f"{path} has no numbers; record the log again, or export its samples")
    unread = tuple(name for name in columns if name not in names)
    return Table(path, names, np.column_stack(data)[:, : len(names)], place, unread)


STEP = "Ts"  # sampling time [s] of a file without stamps, called as in MATLAB's iddata
WIDEST = 256  # columns of one array: more is a picture or a matrix, and no signal


def read_npz(
    path: Path,
    wanted: Callable[[Sequence[str]], Collection[str]] | None,
    stamps: Collection[str] = ("time",),
) -> Table:
    """Reads the table in an `.npz` file; see `formats.log_table`.

    Arrays of shape (n,) and (n, m) are columns, where n is the length that most of them have; a
    single number Ts is the sampling time [s]. Other arrays are left out.

    Raises:
        InputError: it is damaged, or has no arrays of numbers of one length.
    """
    arrays = read_archive(path, ".npz of numpy")
    good = {n: a for n, a in arrays.items()
            if a.dtype.kind in KINDS and a.ndim in (1, 2) and a.size > 1
            and (a.ndim == 1 or a.shape[1] <= WIDEST)}  # fmt: skip
    if not good:
        raise InputError(
            f"{path} has no arrays of numbers of shape (n,) or (n, m); it has"
            f" {listed(arrays) or 'nothing'}; save time, inputs and outputs with np.savez"
        )
    lengths = Counter(len(a) for a in good.values())
    n = max(lengths, key=lambda k: (lengths[k], k))
    columns: dict[str, Callable[[], np.ndarray]] = {}
    for name, array in good.items():
        if len(array) == n:
            width = array.shape[1] if array.ndim == 2 else 0
            for k, column in enumerate(names_of(name, width)):
                columns[column] = partial(np.asarray, array[:, k] if width else array)
    step = arrays.get(STEP)
    if step is not None and step.size == 1 and "time" not in columns:
        if not (step.dtype.kind in KINDS and np.isfinite(step).all() and step.item() > 0):
            raise InputError(f"{path}: {STEP} is no positive number; save the sampling time in s")
        columns = {"time": partial(grid, 0.0, float(step.item()), n), **columns}
    return table_of(path, columns, wanted, stamps, lambda row: f"row {row + 1} of {path}")
