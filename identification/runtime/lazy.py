"""Imports that wait: public names until they are asked for, packages that not everybody has."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any

from identification.errors import InputError

LISTED = r"^    from ([\w.]+) import (\w+) as \2$"


def lazy(package: str) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """Returns `__all__`, `__getattr__` and `__dir__` of a package.

    The list of its public names are the imports in the block `if TYPE_CHECKING` of its
    `__init__.py`: type checkers and editors follow them, and here each is made when its name is
    first asked for.
    """
    imports = re.findall(LISTED, inspect.getsource(sys.modules[package]), re.MULTILINE)
    public = {name: module for module, name in imports}

    def get(name: str) -> Any:
        if name not in public:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        try:
            module = import_module(public[name])
        except AttributeError as error:  # "from ... import" would call it a missing name
            raise ImportError(f"{name} cannot be imported: {error}") from error
        return getattr(module, name)

    return list(public), get, lambda: sorted(public)


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
