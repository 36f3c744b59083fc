"""A linear system in files: `.npz` for Python, `.mat` for MATLAB.

Both have the variables A, B, C, D, x, u, y, rate, states, inputs, outputs and Ts, which is 0 for a
continuous system. In MATLAB:

    s = load('system.mat'); sys = ss(s.A, s.B, s.C, s.D, s.Ts);
    set(sys, 'StateName', s.states, 'InputName', s.inputs, 'OutputName', s.outputs)
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from identification.errors import InputError
from identification.linear.system import LinearSystem
from identification.storage.files import read_archive, whole_file

NAMES = ("states", "inputs", "outputs")
_SHAPES = {
    "A": ("states", "states"), "B": ("states", "inputs"), "C": ("outputs", "states"),
    "D": ("outputs", "inputs"),
}  # fmt: skip
ARRAYS = ("A", "B", "C", "D", "x", "u", "y", "rate")
FORMATS = (".npz", ".mat")


def save_system(system: LinearSystem, path: str | Path) -> Path:
    """Write a system to a file whose name ends in .npz or .mat; returns the path.

    Args:
        system: continuous or discrete.
        path: where to write.

    Raises:
        InputError: the name ends otherwise, or the file cannot be written.
    """
    arrays = {name: getattr(system, name) for name in ARRAYS}
    return write_arrays(
        path, {**arrays, **names_of(system), "Ts": np.array(system.sampling_time or 0.0)}
    )


def names_of(system: Any) -> dict[str, Any]:
    """Returns the names of states, inputs and outputs of a system or of a grid of systems."""
    return {name: getattr(system, name) for name in NAMES}


def load_system(path: str | Path) -> LinearSystem:
    """Read a system that `save_system` wrote as .npz.

    Args:
        path: of the file.

    Raises:
        InputError: there is no such file, or it is no such system.
    """
    content = read_arrays(path, (*ARRAYS, *NAMES, "Ts"), "system of save_system")
    names = names_in(content, path)
    arrays: dict[str, Any] = {name: content[name] for name in ARRAYS}
    for name, array in {**arrays, "Ts": content["Ts"]}.items():
        shape = tuple(len(names[axis]) for axis in _SHAPES.get(name, ()))
        fits = array.shape == shape if name in _SHAPES else array.ndim == int(name != "Ts")
        if not (fits and array.dtype.kind in "fiu" and np.isfinite(array).all()):
            raise InputError(
                f"{path} is damaged: {name} is no array of finite numbers that fits the names of"
                " states, inputs and outputs; write the system again"
            )
    return LinearSystem(**arrays, **names, sampling_time=float(content["Ts"]) or None)


def names_in(content: Mapping[str, np.ndarray], path: str | Path) -> dict[str, Any]:
    """Returns the names of states, inputs and outputs in a file."""
    for name in NAMES:
        if content[name].ndim != 1 or content[name].dtype.kind != "U":
            raise InputError(f"{path} is damaged: {name} is no row of names; write it again")
    return {name: tuple(content[name].tolist()) for name in NAMES}


def write_arrays(path: str | Path, content: Mapping[str, Any]) -> Path:
    """Write arrays and tuples of names as .npz or .mat, whole or not at all; returns the path."""
    path = Path(path)
    if path.suffix not in FORMATS:
        raise InputError(f"{path.name} does not end in {' or '.join(FORMATS)}; name it so")
    with whole_file(path) as draft, draft.open("wb") as stream:
        if path.suffix == ".npz":
            arrays: dict[str, Any] = {name: np.asarray(v) for name, v in content.items()}
            np.savez_compressed(stream, **arrays)
        else:
            from scipy.io import savemat

            # A cell of texts in MATLAB is an array of objects here.
            cells = {
                name: np.array(v, object)[:, None] if isinstance(v, tuple) else v
                for name, v in content.items()
            }
            savemat(stream, cells, oned_as="column", long_field_names=True)
    return path


def read_arrays(path: str | Path, names: tuple[str, ...], what: str) -> dict[str, np.ndarray]:
    """Read variables of an .npz."""
    arrays = read_archive(Path(path), what)
    if missing := [name for name in names if name not in arrays]:
        raise InputError(
            f"{path} is no {what}, or is damaged: it lacks {', '.join(missing)}; write it again"
        )
    return arrays
