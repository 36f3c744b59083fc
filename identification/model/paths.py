"""Paths of parameters, such as `joint/motor_*.damping` or `body/platform.inertia[0]`.

A path is `kind/name.attribute` or `kind/name.attribute[column]`. A `*` in the name stands for all
objects that match, and the parameter writes the same number to each of them. Objects that get the
number multiplied by a factor are `ties` of the parameter.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fnmatch import fnmatchcase

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.model.path_names import (
    DOF,
    KINDS,
    names_of,
    prefix,
    unknown_attribute,
    unknown_object,
)

_PATH = re.compile(r"(?P<kind>\w+)/(?P<name>[^.]+)\.(?P<attribute>\w+)(\[(?P<column>\d+)\])?")


@dataclass(frozen=True)
class Slot:
    """Entries of one mjModel array.

    Attributes:
        field: name of the mjModel array, as `Batch.expand` takes it.
        rows: rows of the array that the path names, shape (k,).
        column: column of the array; None for an array of one dimension.
    """

    field: str
    rows: tuple[int, ...]
    column: int | None

    def index(self) -> tuple[list[int], int] | list[int]:
        """Returns the numpy index of these entries in the array."""
        return list(self.rows) if self.column is None else (list(self.rows), self.column)


def resolve(model: mujoco.MjModel, path: str) -> Slot:
    """Find the entries of mjModel that a path names."""
    match = _PATH.fullmatch(path)
    if match is None:
        raise InputError(
            f"{path!r} is no model path; write kind/name.attribute or kind/name.attribute[column],"
            " e.g. joint/slider.damping"
        )
    kind, attribute = match["kind"], match["attribute"]
    if kind not in KINDS:
        raise unknown_name("kind of object", kind, KINDS)
    ids = [i for i, n in enumerate(names_of(model, kind)) if fnmatchcase(n, match["name"])]
    if not ids:
        raise unknown_object(model, kind, match["name"], attribute)
    field = f"{prefix(kind)}{attribute}"
    if kind == "joint" and attribute in DOF:
        field, ids = f"dof_{attribute}", [int(model.jnt_dofadr[i]) for i in ids]
    array = getattr(model, field, None)
    if not isinstance(array, np.ndarray):
        raise unknown_attribute(model, kind, ids[0], attribute)
    column = None if match["column"] is None else int(match["column"])
    width = array.shape[1] if array.ndim == 2 else None
    if (column is None) != (width is None) or (width is not None and column >= width):
        raise InputError(
            f"{path!r}: {field} is one number, write no [column]"
            if width is None
            else f"{path!r}: {field} has columns 0 to {width - 1}, write one as [0]"
        )
    return Slot(field, tuple(ids), column)


def write(model: mujoco.MjModel, slot: Slot, value: float) -> None:
    """Write a value to all entries of a slot of a model, in place."""
    getattr(model, slot.field)[slot.index()] = value


def read(model: mujoco.MjModel, slot: Slot) -> float:
    """Returns the value that a slot holds; its entries are equal when one parameter wrote them."""
    return float(getattr(model, slot.field)[slot.index()][0])
