"""result.json: what was found as plain values, with how it was asked for and what made it."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

from identification.errors import InputError
from identification.quantities import plain
from identification.storage.files import read_json, readable, write_text

RESULT = "result.json"
PACKAGES = ("inca-mj", "mujoco", "numpy", "scipy", "numba")
CURE = "give a folder that found.save(folder) or --out has written, or its result.json"


def write_result(path: Path, command: Any, result: Mapping[str, Any]) -> None:
    """Write result.json: the result, the resolved configuration and the versions that made it.

    Args:
        path: of the file.
        command: a record whose fields are the configuration; None where Python asked.
        result: what was found.

    Raises:
        InputError: the file cannot be written.
    """
    record = {
        **plain_text(result),
        "configuration": plain_text(asdict(command)) if is_dataclass(command) else {},  # type: ignore[arg-type]
        "versions": {
            "python": sys.version.split()[0], **{p: package_version(p) for p in PACKAGES}
        },
    }  # fmt: skip
    write_text(path, json.dumps(record, indent=1, allow_nan=False) + "\n")


def read_result(path: str | Path) -> dict[str, Any]:
    """Returns what a result.json holds.

    Args:
        path: of the file, or of its folder.

    Raises:
        InputError: the file is not there or is no JSON object.
    """
    path = Path(path)
    file = path / RESULT if path.is_dir() else path
    record = read_json(file, "result.json", CURE)
    if not isinstance(record, dict):
        raise InputError(f"{file} holds no JSON object; {CURE}")
    return record


def plain_text(value: Any) -> Any:
    """Returns plain values for JSON, with paths as text, and text that every reader takes."""
    if isinstance(value, Mapping):
        return {k: plain_text(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain_text(v) for v in value]
    return readable(str(value)) if isinstance(value, Path | str) else plain(value)


def package_version(package: str, missing: str = "not installed") -> str:
    """Returns the version of an installed package; `missing` without one."""
    from importlib.metadata import PackageNotFoundError, version  # slow to import

    try:
        return version(package)
    except PackageNotFoundError:  # run from a source tree
        return missing
