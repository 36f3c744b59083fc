"""A method: what a sweep repeats. It is a function of settings and a seed, and returns one record.

    record = run(settings, seed)      a flat dict, one entry for each column of the method

The settings are a frozen dataclass of plain values. A task names its method by a reference, so that
a worker on another machine can import it: `module:NAME` of an installed package, or `file.py:NAME`.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from hashlib import sha256
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from identification.errors import InputError, unknown_name
from identification.storage.files import BY_HAND, check_file, is_file

if TYPE_CHECKING:
    from identification.report.page.page import Section

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
        """Returns the sequence itself, which spawns further ones."""
        return np.random.SeedSequence(self.entropy, spawn_key=self.key)

    def generator(self) -> np.random.Generator:
        """Returns a generator of random numbers, the same each time."""
        return np.random.default_rng(self.sequence())

    def number(self) -> int:
        """Returns a whole number from 0 to 2³¹ - 1, for functions that take such a seed."""
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
    """The findings of a study's records, beyond the rates that every study has.

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
    """A method, which a sweep repeats.

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
    """Returns the reference by which a worker finds a method, or refuses a word that names none.

    The word is a registered name, or `file.py:NAME` of a method of your own, from the folder.
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


@contextmanager
def told_in_method(reference: str, what: str) -> Iterator[None]:
    """Refuses an error of a method's own code, with file and line; `sys.exit` in it is one too."""
    try:
        yield
    except (InputError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        raise InputError(
            f"the method {reference} {what}: {error_line(error, reference)}; correct it there"
        ) from error


def error_line(error: BaseException, reference: str) -> str:
    """Returns kind and message of an error, with the file and the line that raised it.

    The line is the last one of the method's own file, where it had a part. A refusal of input says
    itself what is wrong, and has no line.
    """
    try:
        text = " ".join(str(error).split())
    except Exception:  # an error of a user may fail even at this
        text = "without a message"
    name = type(error).__name__
    calls = traceback.extract_tb(error.__traceback__)
    if isinstance(error, SyntaxError | InputError) or not calls:  # their messages say where
        return f"{name}: {text}"
    file = reference.rpartition(":")[0]
    last = next((c for c in reversed(calls) if c.filename == file), calls[-1])
    return f"{name}: {text} ({Path(last.filename).name}, line {last.lineno})"


def load_method(reference: str) -> Method:
    """Imports a method; refuses a module that cannot be imported, or has no such method."""
    place, _, name = reference.rpartition(":")
    with told_in_method(reference, "cannot be imported"):
        module = _load_file(Path(place)) if place.endswith(".py") else import_module(place)
    method = getattr(module, name, None)
    if not isinstance(method, Method):
        good = [n for n, value in vars(module).items() if isinstance(value, Method)]
        raise InputError(
            f"{reference} names no method; {place} has {', '.join(good) or 'none'} (a Method)"
        )
    return method


def _load_file(path: Path) -> ModuleType:
    """Loads a module from a file, once in a process; files beside it can be imported too."""
    name = f"_sweep_{path.stem}_{sha256(str(path).encode()).hexdigest()[:12]}"
    if name in sys.modules:
        return sys.modules[name]
    check_file(path, BY_HAND, "Python file with a method")
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
