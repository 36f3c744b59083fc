"""Archives of numpy to a table: each array is a column, or a column for each of its entries."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.files import read_archive
from identification.logs.arrays import KINDS, names_of, table_of
from identification.logs.names import listed
from identification.logs.sampling import grid
from identification.logs.table import Table

STEP = "Ts"  # sampling time [s] of a file without stamps, called as in MATLAB's iddata
WIDEST = 256  # columns of one array: more is a picture or a matrix, and no signal


def read_npz(
    path: Path,
    wanted: Callable[[Sequence[str]], Collection[str]] | None,
    stamps: Collection[str] = ("time",),
) -> Table:
    """Reads the table in an `.npz` file.

    Arrays of shape (n,) and (n, m) are columns, where n is the length that most of them have; a
    single number Ts is the sampling time [s]. Other arrays are left out.

    Args:
        path: of the file.
        wanted: says which of its columns to read; all when None.
        stamps: columns of time.

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
