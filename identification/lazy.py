"""Imports that wait: public names until they are asked for, packages that not everybody has."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any

from identification.errors import InputError


def lazy(
    package: str, public: Mapping[str, str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Returns a package's `__getattr__` and `__dir__`."""

    def get(name: str) -> Any:
        if name not in public:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        try:
            module = import_module(f"{package}.{public[name]}")
        except AttributeError as error:  # "from ... import" would call it a missing name
            raise ImportError(f"{name} cannot be imported: {error}") from error
        return getattr(module, name)

    return get, lambda: sorted(public)


def needed(module: str, extra: str, what: str) -> ModuleType:
    """Import a module of an extra.

    Args:
        module: such as "pyarrow.parquet".
        extra: of this distribution that brings it.
        what: needs it.

    Raises:
        InputError: it is not installed; the message says what to install.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        name = module.partition(".")[0]
        raise InputError(
            f"{what} needs {name}, which is not installed; run pip install 'inca-mj[{extra}]'"
        ) from error
