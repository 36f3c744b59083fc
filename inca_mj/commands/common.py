"""What the commands share: which robot, where results go, how they are said."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

if TYPE_CHECKING:
    from identification.parameter import ParameterSet
    from inca_mj.geometry import Geometry


@dataclass(frozen=True)
class Robot:
    """Which robot: a parameter set, some values of your own, a geometry of your own."""

    set: Literal["trial", "simulation"] = "trial"
    """Parameter set: the thesis' Table 3.2 (trial) or Table 2.1 (simulation)."""
    param: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME=VALUE")] = ()
    """Values of your own in SI units, such as m=0.2 lambda=26000."""
    geometry: Path | None = None
    """TOML file with exit points and connectors; the built-in ones are assumed."""

    def parameters(self) -> ParameterSet:
        """The parameter set with the values replaced.

        Raises:
            InputError: a value is malformed, unknown or out of bounds.
        """
        from inca_mj.parameters import parameters

        return parameters(self.set, dict(_assignment(text) for text in self.param))

    def place(self) -> Geometry:
        """The geometry.

        Raises:
            InputError: the file cannot be read as one.
        """
        from inca_mj.geometry import INCA, read_geometry

        return INCA if self.geometry is None else read_geometry(self.geometry)


def _assignment(text: str) -> tuple[str, float]:
    from identification.errors import InputError

    name, equals, value = text.partition("=")
    try:
        if not equals:
            raise ValueError
        return name.strip(), float(value)
    except ValueError:
        raise InputError(f"{text!r} is not NAME=VALUE; write e.g. --param m=0.2") from None


@dataclass(frozen=True)
class Output:
    """How results are said and kept."""

    json: bool = False
    """Print one JSON object on stdout and nothing else."""
    out: Path | None = None
    """Folder for figures, report, model and result.json; made when missing."""


def folder(path: Path) -> Path:
    """Make a folder for results.

    Raises:
        InputError: it cannot be made.
    """
    from identification.errors import InputError

    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make folder {path}: {error.strerror}; choose another") from None
    return path


def say(text: str) -> None:
    """One line of result on stdout."""
    sys.stdout.write(text + "\n")


def note(text: str) -> None:
    """One line about progress on stderr."""
    sys.stderr.write(text + "\n")


def say_json(result: Mapping[str, Any]) -> None:
    """The result as one JSON object on stdout; what is not finite is null."""
    say(json.dumps(result, allow_nan=False))


def write_result(path: Path, command: Any, result: Mapping[str, Any]) -> None:
    """Write result.json: the result, the resolved configuration and the versions that made it."""
    from importlib.metadata import version

    from identification.files import write_text

    packages = ("inca-mj", "mujoco", "numpy", "scipy", "numba")
    record = {
        **result,
        "configuration": _plain(asdict(command)) if is_dataclass(command) else {},  # type: ignore[arg-type]
        "versions": {"python": sys.version.split()[0], **{p: version(p) for p in packages}},
    }
    write_text(path, json.dumps(record, indent=1, allow_nan=False) + "\n")


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, Path) else value


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A plain text table, numbers to the right."""
    widths = [max(len(r[i]) for r in [head, *rows]) for i in range(len(head))]
    lines = ("  ".join(cell.rjust(w) for cell, w in zip(r, widths, strict=True)) for r in [head, *rows])
    return "\n".join(lines)


robot_field: Any = field(default_factory=Robot)
output_field: Any = field(default_factory=Output)
