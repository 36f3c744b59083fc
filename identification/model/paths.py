"""Paths of parameters, such as `joint/motor_*.damping` or `body/platform.inertia[0]`.

A path is `kind/name.attribute` or `kind/name.attribute[column]`. A `*` in the name stands for all
objects that match, and the parameter writes the same number to each of them. Objects that get the
number multiplied by a factor are `ties` of the parameter.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name

KINDS = {
    "body": ("nbody", mujoco.mjtObj.mjOBJ_BODY),
    "joint": ("njnt", mujoco.mjtObj.mjOBJ_JOINT),
    "site": ("nsite", mujoco.mjtObj.mjOBJ_SITE),
    "geom": ("ngeom", mujoco.mjtObj.mjOBJ_GEOM),
    "tendon": ("ntendon", mujoco.mjtObj.mjOBJ_TENDON),
    "actuator": ("nactuator", mujoco.mjtObj.mjOBJ_ACTUATOR),
}
DOF = ("damping", "armature", "frictionloss")  # of a joint, kept per degree of freedom
_MORE = {
    "joint": DOF,
    "body": ("spread",),
    "actuator": ("kp", "kv", "timeconst", "resistance", "motorconst"),
}  # beside the arrays
_JOINT = int(mujoco.mjtTrn.mjTRN_JOINT)
_ON_A_BODY = ("joint", "site", "geom")
# What MuJoCo computes of other numbers: nobody gives it, and to write it is in vain.
_COMPUTED = ("aabb", "acc0", "invweight0", "length0", "lengthrange", "rbound", "subtreemass")
_PATH = re.compile(r"(?P<kind>\w+)/(?P<name>[^.]+)\.(?P<attribute>\w+)(\[(?P<column>\d+)\])?")


@dataclass(frozen=True)
class Slot:
    """Entries of one mjModel array."""

    field: str  # name of the mjModel array, as `Batch.expand` takes it
    rows: tuple[int, ...]  # rows of the array that the path names, shape (k,)
    column: int | None  # column of the array; None for an array of one dimension

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


def read(model: mujoco.MjModel, slot: Slot) -> float:
    """Returns the value that a slot holds; its entries are equal when one parameter wrote them."""
    return float(getattr(model, slot.field)[slot.index()][0])


def write(model: mujoco.MjModel, slot: Slot, value: float) -> None:
    """Write a value to all entries of a slot of a model, in place."""
    getattr(model, slot.field)[slot.index()] = value


def unknown_object(model: mujoco.MjModel, kind: str, name: str, attribute: str) -> InputError:
    """Returns the error for a path to an object that a model does not have."""
    named = sorted(filter(None, names_of(model, kind)))
    meant = _meant(_with_that_name(model, name, attribute, besides=kind))
    if named:
        error = unknown_name(kind, name, named)
        return InputError(f"{error}{'; or' if meant else ''}{meant}")
    if getattr(model, KINDS[kind][0]):
        why, cure = f"no {kind} of the model has a name", f"give it one to free its {attribute}"
    else:
        why, cure = f"the model has no {kind}", "free a number that it has"
    return InputError(f"unknown {kind} {name!r}: {why};{meant or f' {cure}'}")


def unknown_attribute(model: mujoco.MjModel, kind: str, row: int, attribute: str) -> InputError:
    """Returns the error for a path to an attribute that a kind of object does not have."""
    meant = _meant(_around(model, kind, row, attribute))
    a = "an" if kind[0] in "aeiou" else "a"
    error = unknown_name(f"attribute of {a} {kind}", attribute, attributes(model, kind))
    return InputError(f"{error}{'; or' if meant else ''}{meant}")


def names_of(model: mujoco.MjModel, kind: str) -> list[str]:
    """Returns the names of all objects of a kind in the model's order, "" of those without one."""
    count, kind_id = KINDS[kind]
    return [mujoco.mj_id2name(model, kind_id, i) or "" for i in range(getattr(model, count))]


def attributes(model: mujoco.MjModel, kind: str) -> tuple[str, ...]:
    """Returns the attributes that a path may name of a kind of object, by their names in MJCF."""
    start = prefix(kind)
    arrays = (
        name.removeprefix(start)
        for name in dir(model)
        if name.startswith(start)
        and isinstance(array := getattr(model, name), np.ndarray)
        and array.dtype.kind == "f"
    )
    given = {name for name in arrays if name not in _COMPUTED}
    return tuple(sorted({*given, *_MORE.get(kind, ())}))


def prefix(kind: str) -> str:
    """Returns what the arrays of mjModel on a kind of object begin with."""
    return "jnt_" if kind == "joint" else f"{kind}_"


def _with_that_name(
    model: mujoco.MjModel, name: str, attribute: str, besides: str
) -> Iterator[str]:
    """Yields paths to the same attribute of objects of other kinds that have the same name."""
    for kind in KINDS:
        if kind != besides and name in names_of(model, kind) and name:
            if attribute in attributes(model, kind):
                yield f"{kind}/{name}.{attribute}"
            else:
                row = names_of(model, kind).index(name)
                yield from _around(model, kind, row, attribute)


def _around(model: mujoco.MjModel, kind: str, row: int, attribute: str) -> Iterator[str]:
    """Yields paths to the same attribute of an object's body, a body's joints, a joint's drives."""
    if kind in _ON_A_BODY and attribute in attributes(model, "body"):
        body = int(getattr(model, f"{prefix(kind)}bodyid")[row])
        if name := names_of(model, "body")[body]:
            yield f"body/{name}.{attribute}"
    if kind == "body" and attribute in attributes(model, "joint"):
        joints = names_of(model, "joint")
        yield from (f"joint/{joints[j]}.{attribute}" for j in range(model.njnt)
                    if model.jnt_bodyid[j] == row and joints[j])  # fmt: skip
    if kind == "joint" and attribute in attributes(model, "actuator"):
        drives = names_of(model, "actuator")
        yield from (f"actuator/{drives[i]}.{attribute}" for i in range(len(drives))
                    if model.actuator_trntype[i] == _JOINT and model.actuator_trnid[i, 0] == row
                    and drives[i])  # fmt: skip


def _meant(paths: Iterator[str]) -> str:
    """Returns the question that offers other paths; "" where there are none."""
    found = [repr(path) for path in dict.fromkeys(paths)]
    return f" did you mean {' or '.join(found)}?" if found else ""
