"""MATLAB to a table: `u` (n, nu), `y` (n, ny) and the scalar `Ts` [s], as `iddata` calls them."""

from __future__ import annotations

import io
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.logs.names import listed
from identification.logs.sampling import FloatArray, grid
from identification.logs.table import Table
from identification.runtime.child import MATRIX, REFUSED, run_child

SECONDS = 120.0  # of reading, after which a file is taken for damaged


def parse_mat(
    raw: bytes,
    path: Path,
    inputs: Sequence[str],
    outputs: Sequence[str],
    optional: Sequence[str],
) -> Table:
    """Reads the table in a `.mat` file of version 7 or older.

    An optional column is a vector of the same name; it cannot be called `u` or `y`.
    """
    content = _loaded(raw, path)
    wanted = {"u": inputs, "y": outputs}
    found = [*content]
    lacking = [k for k, names in wanted.items() if names and k not in content]
    if lacking:
        raise InputError(
            f"{path} lacks {listed(lacking)}; it has {listed(found) or 'nothing'}; save u (inputs, "
            "one column each), y (outputs) and Ts (sampling time in s)"
        )
    arrays = {k: _numeric(content[k], k, path) for k, names in wanted.items() if names}
    n = _samples(arrays, wanted, path)
    parts = [a if a.shape == (n, len(wanted[k])) else a.T for k, a in arrays.items()]
    names = [*inputs, *outputs]
    for name in optional:
        if name not in content or name in wanted:
            continue
        extra = _numeric(content[name], name, path).reshape(-1, 1)
        if len(extra) != n:
            raise InputError(
                f"{path}: {name} has {len(extra)} numbers and the log has {n} samples; "
                "save one for each sample"
            )
        names.append(name)
        parts.append(extra)
    if "Ts" in content:
        names.insert(0, "time")
        parts.insert(0, grid(0.0, _step(content["Ts"], path), n)[:, None])
    return Table(path, tuple(names), np.hstack(parts), lambda row: f"row {row + 1} of {path}")


def _loaded(raw: bytes, path: Path) -> dict[str, np.ndarray | None]:
    """Reads the variables by name in another process; None for one that is no full real matrix."""
    try:
        done = run_child("matlab", raw, SECONDS)
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{path} is not read within {SECONDS:g} s; save it again with save(..., '-v7')"
        ) from None
    if done.returncode == REFUSED:
        raise InputError(f"{path} is a MATLAB 7.3 (HDF5) file; save it again with save(..., '-v7')")
    if done.returncode:
        raise InputError(
            f"{path} cannot be read as a MATLAB file; save it again with save(..., '-v7')"
        )
    with np.load(io.BytesIO(done.stdout)) as arrays:
        return {n[1:]: arrays[n] if n.startswith(MATRIX) else None for n in arrays}


def _numeric(value: np.ndarray | None, name: str, path: Path) -> FloatArray:
    if value is None:
        raise InputError(f"{path}: {name} is not a full real matrix; save it as double({name})")
    return value.astype(np.float64)


def _step(value: np.ndarray | None, path: Path) -> float:
    array = _numeric(value, "Ts", path)
    if array.size != 1 or not (np.isfinite(array).all() and array.item() > 0):
        raise InputError(f"{path}: Ts is not one positive number; save the sampling time in s")
    return array.item()


def _samples(arrays: dict[str, FloatArray], wanted: dict[str, Sequence[str]], path: Path) -> int:
    """Returns the n for which all matrices are (n, names), or all are transposed."""
    upright = {a.shape[0] for k, a in arrays.items() if a.shape[1] == len(wanted[k])}
    lying = {a.shape[1] for k, a in arrays.items() if a.shape[0] == len(wanted[k])}
    fits = [
        n
        for n in sorted(upright | lying)
        if all({n, len(wanted[k])} == set(a.shape) for k, a in arrays.items())
    ]
    if len(fits) == 1:
        return fits[0]
    shapes = " and ".join(f"{k} is {a.shape[0]} x {a.shape[1]}" for k, a in arrays.items())
    needs = " and ".join(f"{k} n x {len(wanted[k])}" for k in arrays)
    raise InputError(f"{path}: {shapes}; save {needs}, one row for each of the same n samples")
