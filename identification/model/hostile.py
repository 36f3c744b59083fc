"""Models that MuJoCo would read for hours, or not at all, are refused before.

An MJCF may ask for more than it writes: a `replicate` of a `replicate` multiplies what it holds.
MuJoCo cannot be stopped while it reads a model, and may take minutes or all memory: replicated
elements cost the square of their number, and heightfields, meshes and user data cost memory. What a
model asks for is counted in its text, in milliseconds. Only where a count is far beyond that of the
robots of MuJoCo Menagerie, another process compiles the model first
(`identification.runtime.child`). So a usual model pays nothing, and a large one its compilation
twice.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from identification.errors import InputError
from identification.runtime.child import FAILED, MEMORY, REFUSED, SECONDS, run_child
from identification.storage.files import MAX_BYTES, MODEL, check_file, exists, read_bytes

ELEMENTS = 2000  # are read in 0.1 s; ten times as many take 20 s
CELLS = 2**20  # of heightfields and textures; they are compiled in 0.03 s
NUMBERS = 10_000  # of user data of one kind of element
BYTES = 2**24  # of the text, of what it includes, and of the files that it names
LARGEST = 2**27  # [bytes] of a compiled model; a search simulates some hundred copies at once
_WAITING = 20  # times as long for a process whose machine has others to serve
_FEWER_REPLICAS = "lower its counts of replicate"
_SMALLER_GRIDS = "make its heightfields and textures smaller"
_SMALLER_FILES = "make the meshes and other files that it names smaller"
_SMALLER_ANY = (
    f"{_FEWER_REPLICAS} and its sizes nuser_*, or make its heightfields and meshes smaller"
)
MOST = 20_000  # elements, replicated ones counted each; robots have hundreds
STEP = (1e-7, 1.0)  # least and largest timestep [s]
HUGE = 1e50  # of any unit: squares and cubes of it are numbers too
DEEPEST = 20  # files that include each other
_FILES = MAX_BYTES, "file of a mesh, a texture or a heightfield"
_FOLDERS = ("meshdir", "texturedir", "assetdir")
_COUNTS = {"composite": "count", "flexcomp": "count"}
_GRIDS = {"hfield": ("nrow", "ncol"), "texture": ("width", "height")}
_CELLS = 2**26
# What the engine can do beside its steps, and what our simulations of many values at once cannot.
_UNSUPPORTED = {"mjENBL_SLEEP": "sleep", "mjENBL_IPC": "ipc"}
_FINITE = (
    "body_mass", "body_inertia", "body_ipos", "body_pos", "dof_armature", "dof_damping",
    "dof_frictionloss", "jnt_stiffness", "jnt_pos", "qpos0", "actuator_gear", "actuator_gainprm",
    "actuator_biasprm", "actuator_dynprm",
)  # fmt: skip


@dataclass(frozen=True)
class Amount:
    """The amounts that a model asks for, as its text says them."""

    elements: float = 0.0  # of the text, those that repeat counted each
    cells: float = 0.0  # of heightfields and textures
    numbers: float = 0.0  # of user data, of the kind of element that has most
    size: int = 0  # of the text, of what it includes, and of the files that it names [bytes]
    user_data: str = ""  # the attribute of <size> that asks for these numbers, such as "nuser_body"

    @property
    def much(self) -> tuple[str, ...]:
        """Advice on what to make smaller, a clause for each count far beyond that of robots."""
        lower = f"lower {self.user_data}, which asks for {self.numbers:.3g} numbers of each element"
        each = (
            (self.numbers > NUMBERS, lower), (self.elements > ELEMENTS, _FEWER_REPLICAS),
            (self.cells > CELLS, _SMALLER_GRIDS), (self.size > BYTES, _SMALLER_FILES),
        )  # fmt: skip
        return tuple(clause for is_large, clause in each if is_large)


def refuse_hostile(raw: str | bytes, where: str, folder: Path | None = None) -> Amount:
    """Refuses a model by its text and that of the files it includes; returns what it asks for.

    `where` is the model in messages, such as "the model slider.xml"; without a folder it is in no
    file.
    """
    amount = _amount(raw, where, folder, 0)
    if amount.elements > MOST:
        raise InputError(
            f"{where} has {amount.elements:.3g} elements when all that repeat are counted, more"
            f" than {MOST}; lower the counts of replicate, composite and flexcomp"
        )
    return amount


def refuse_numbers(model: mujoco.MjModel, where: str) -> None:
    """Refuses a compiled model that cannot be simulated for its flags, its size or its numbers."""
    for flag, word in _UNSUPPORTED.items():
        if model.opt.enableflags & int(getattr(mujoco.mjtEnableBit, flag, 0)):
            raise InputError(
                f'{where} has <flag {word}="enable"/>, with which no two simulations of it can be'
                f' compared; write <flag {word}="disable"/>'
            )
    refuse_size(mujoco.mj_sizeModel(model), where)
    (least, most), step = STEP, model.opt.timestep
    if not least <= step <= most:
        raise InputError(
            f"{where} has the timestep {step:g} s; give <option timestep> a number from {least:g}"
            f" to {most:g}"
        )
    numbers = {field: getattr(model, field) for field in _FINITE}
    numbers["gravity"] = model.opt.gravity
    for field, values in numbers.items():
        if not np.isfinite(values).all():
            raise InputError(f"{where} has an infinite number in {field}; write a finite one")
        if values.size and np.abs(values).max() > HUGE:
            raise InputError(
                f"{where} has {values.flat[np.abs(values).argmax()]:g} in {field}, which no robot"
                f" has; write a number up to {HUGE:g}"
            )


def refuse_endless(source: str | Path, where: str, amount: Amount) -> None:
    """Refuses a model that is not compiled within a bound of time and memory."""
    cure, is_file = _cure(amount), isinstance(source, Path)
    raw, path = (b"", str(source)) if is_file else (str(source).encode(), "")
    try:
        done = run_child("model", raw, _WAITING * SECONDS, path)
    except subprocess.TimeoutExpired:
        raise InputError(f"{where} is not compiled by MuJoCo in time; {cure}") from None
    if done.returncode == FAILED:
        raise InputError(
            f"{where} takes more than {MEMORY / 2**30:.0f} GB of memory while MuJoCo"
            f" compiles it; {cure}"
        )
    if done.returncode == 0:
        refuse_size(int(done.stdout), where, amount)
    elif done.returncode != REFUSED:  # ended by its limit, or a crash
        raise InputError(f"{where} is not compiled by MuJoCo within {SECONDS} s; {cure}")


def refuse_size(size: int, where: str, amount: Amount | None = None) -> None:
    """Refuses a compiled model of so many bytes of which a search cannot hold its copies."""
    if size > LARGEST:
        raise InputError(
            f"{where} has {size / 2**20:.0f} MB when it is compiled, more than the"
            f" {LARGEST / 2**20:.0f} MB of which a search can hold its copies; {_cure(amount)}"
        )


def _cure(amount: Amount | None) -> str:
    """Says what to make smaller: what the text asks much of, or whatever makes a model large."""
    return " and ".join(amount.much) if amount and amount.much else _SMALLER_ANY


def _amount(raw: str | bytes, where: str, folder: Path | None, depth: int) -> Amount:
    """Returns what a text and the files that it names ask for."""
    if depth > DEEPEST:
        raise InputError(f"{where} includes itself; take the <include> out")
    try:
        root = ElementTree.fromstring(raw)
        names = {str(element.get("name")) for element in root.iter()}
        _refuse_nan(root, names, where)
        elements = _count(root, where)
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        text = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise InputError(f"{where} cannot be read ({text}); correct it there") from error
    grids = [_product(" ".join(e.get(name, "1") for name in _GRIDS[e.tag]))
             for e in root.iter() if e.tag in _GRIDS]  # fmt: skip
    users = [(_product(number), name) for e in root.iter("size") for name, number in e.items()
             if name.startswith("nuser_")]  # fmt: skip
    numbers, user_data = max(users, default=(0.0, ""))
    size = len(raw) + (0 if folder is None else sum(_sizes(root, folder)))
    parts = [Amount(elements, sum(grids), numbers, size, user_data)]
    parts += [_amount(read_bytes(file, what=MODEL), f"the model {file}", folder, depth + 1)
              for file in (() if folder is None else _included(root, folder))]  # fmt: skip
    most = max(parts, key=lambda part: part.numbers)
    return replace(
        most,
        elements=sum(part.elements for part in parts),
        cells=sum(part.cells for part in parts),
        size=sum(part.size for part in parts),
    )


def _included(root: ElementTree.Element, folder: Path) -> tuple[Path, ...]:
    """Returns the files that a text includes; MuJoCo tells of those that are missing."""
    files = (folder / element.get("file", "") for element in root.iter("include"))
    return tuple(file for file in files if exists(file) and file != folder)


def _sizes(root: ElementTree.Element, folder: Path) -> Iterator[int]:
    """Yields the sizes [bytes] of the files that a text names beside the ones it includes."""
    folders = {folder / element.get(name, "") for element in root.iter("compiler")
               for name in _FOLDERS} | {folder}  # fmt: skip
    for element in root.iter():
        named = element.get("file")
        if named and element.tag != "include":
            for file in {place / named for place in folders}:
                if exists(file):
                    check_file(file, *_FILES)
                    yield file.stat().st_size


def _refuse_nan(root: ElementTree.Element, names: set[str], where: str) -> None:
    for element in root.iter():
        for name, value in element.items():
            if "nan" in value.lower().split() and value not in names:
                raise InputError(
                    f"{where} has {name}={value!r} in <{element.tag}>; write numbers there"
                )


def _count(element: ElementTree.Element, where: str) -> float:
    """Returns how many elements one becomes, its parts among them."""
    sides = " ".join(element.get(name, "1") for name in _GRIDS.get(element.tag, ()))
    if _product(sides) > _CELLS:
        raise InputError(
            f"{where} has a <{element.tag}> of more than {_CELLS} cells; make it smaller"
        )
    times = _product(element.get(_COUNTS.get(element.tag, ""), "1"))
    if element.tag == "replicate":
        times = _product(element.get("count", "1"))
    return max(1.0, times) * (1 + sum(_count(part, where) for part in element))


def _product(text: str) -> float:
    """Returns the product of an attribute's numbers; 1 where they are none, which MuJoCo tells."""
    out = 1.0
    for word in text.split():
        try:
            out *= max(1.0, float(word))
        except ValueError:
            return 1.0
    return out
