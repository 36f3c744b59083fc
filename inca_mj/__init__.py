"""The digital twin of the INCA 6D: eight elastic cables, eight motors with drums, a handle.

The public names; each is imported when it is first asked for, so that `inca --help` is quick.
"""

from importlib import import_module
from typing import Any

_PUBLIC = {
    "Comparison": "comparison",
    "Geometry": "geometry",
    "INCA": "geometry",
    "Run": "run",
    "Twin": "twin",
    "build_twin": "twin",
    "compare": "comparison",
    "load_run": "run",
    "load_twin": "effects.saved",
    "make_input": "inputs",
    "parameter_set": "parameters",
    "read_geometry": "geometry",
    "read_inca_log": "logs",
    "run_to_log": "logs",
    "save_run": "run",
    "save_twin": "effects.saved",
    "simulate": "run",
}
__all__ = list(_PUBLIC)


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        module = import_module(f"{__name__}.{_PUBLIC[name]}")
    except AttributeError as error:  # "from ... import" would call it a missing name
        raise ImportError(f"{name} cannot be imported: {error}") from error
    return getattr(module, name)


def __dir__() -> list[str]:
    return sorted(_PUBLIC)
