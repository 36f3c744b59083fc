"""A method: what a sweep repeats. It is a function of settings and a seed, and returns one record.

    record = run(settings, seed)      a flat dict, one entry for each column of the method

The settings are a frozen dataclass of plain values. A task names its method by a reference, so that
a worker on another machine can import it: `module:NAME` of an installed package, or `file.py:NAME`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from identification.errors import InputError, unknown_name
from identification.files import is_file

if TYPE_CHECKING:
    from identification.report.page import Section

Record = Mapping[str, Any]
Registry = Mapping[str, str]  # the reference of each method by its name


@dataclass(frozen=True)
class Seed:
    """The seed of one task: a child that `numpy.random.SeedSequence.spawn` would make.

    Attributes:
        entropy: of the whole sweep.
        key: which child of which child, as `SeedSequence.spawn_key` has it.
    """

    entropy: int
    key: tuple[int, ...]

    def sequence(self) -> np.random.SeedSequence:
        """The sequence itself, which spawns further ones."""
        return np.random.SeedSequence(self.entropy, spawn_key=self.key)

    def generator(self) -> np.random.Generator:
        """A generator of random numbers, the same each time."""
        return np.random.default_rng(self.sequence())

    def number(self) -> int:
        """A whole number from 0 to 2³¹ - 1, for functions that take such a seed."""
        return int(self.sequence().generate_state(1)[0] >> np.uint32(1))


@dataclass(frozen=True)
class Column:
    """A column of a record.

    Attributes:
        kind: bool, int, float or str, or a list of these, such as `list[str]`.
        about: what it says, with its unit; it is kept in the Parquet file too.
    """

    kind: Any
    about: str


@dataclass(frozen=True)
class Findings:
    """What the records of a study come to, beyond the rates that every study has.

    Attributes:
        record: plain values for result.json.
        sections: of the report.
        sentences: the most important first.
    """

    record: Mapping[str, Any] = field(default_factory=dict)
    sections: Sequence[Section] = ()
    sentences: Sequence[str] = ()


@dataclass(frozen=True, kw_only=True)
class Method:
    """What a sweep repeats.

    Attributes:
        about: what it does, in one sentence.
        settings: a frozen dataclass; its fields are bool, int, float, str or Path, or one of these
            and None. Its `__post_init__` refuses what cannot be.
        columns: of its record, by name.
        run: makes the record from settings and a `Seed`.
        success: a column of bool of which power curves are drawn; "" for none.
        against: the setting on the axis of the power curves, where the grid has it.
        summary: what rows of records come to; each row also has the settings, as `set.NAME`.
    """

    about: str
    settings: type
    columns: Mapping[str, Column]
    run: Callable[[Any, Seed], Record]
    success: str = ""
    against: str = ""
    summary: Callable[[Sequence[Record]], Findings] | None = None


def reference_of(word: str, known: Registry, folder: Path) -> str:
    """The reference by which a worker finds a method.

    Args:
        word: a registered name, or `file.py:NAME` of a method of your own.
        known: the registered ones.
        folder: in which the file is looked for.

    Raises:
        InputError: there is no such method.
    """
    file, colon, name = word.rpartition(":")
    if colon and file.endswith(".py"):
        path = folder / file
        if not is_file(path):
            raise InputError(f"method {word!r}: there is no file {path}; correct the path")
        return f"{path.resolve()}:{name}"
    if word not in known:
        error = unknown_name("method", word, known)
        raise InputError(f"{error}; a method of your own is file.py:NAME (docs/sweeps.md)")
    return known[word]


def load_method(reference: str) -> Method:
    """Import a method.

    Args:
        reference: the result of `reference_of`.

    Raises:
        InputError: the module cannot be imported, or has no method of that name.
    """
    place, _, name = reference.rpartition(":")
    try:
        module = _load_file(Path(place)) if place.endswith(".py") else import_module(place)
    except (ImportError, SyntaxError, OSError) as error:
        raise InputError(f"the method {reference} cannot be imported: {error}") from error
    method = getattr(module, name, None)
    if not isinstance(method, Method):
        good = [n for n, value in vars(module).items() if isinstance(value, Method)]
        raise InputError(
            f"{reference} names no method; {place} has {', '.join(good) or 'none'} (a Method)"
        )
    return method


def _load_file(path: Path) -> ModuleType:
    """A module from a file, once in a process; what lies beside it can be imported too."""
    name = f"_sweep_{path.stem}_{sha256(str(path).encode()).hexdigest()[:12]}"
    if name in sys.modules:
        return sys.modules[name]
    spec = spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no Python file")
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))
    module = sys.modules[name] = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module
