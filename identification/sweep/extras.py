"""Packages that the plain installation lacks, and the sentence that says which."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from identification.errors import InputError


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
