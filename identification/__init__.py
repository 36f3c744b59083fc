"""Identification of a MuJoCo model from logs of the robot it stands for.

The public names; each is imported when it is first asked for, so that reading a log needs no
simulator and a bad graphics setting cannot stop it.
"""

from importlib import import_module
from typing import Any

_PUBLIC = {
    "DivergenceError": "errors",
    "Estimate": "estimation",
    "Experiment": "experiment",
    "Fit": "fit",
    "GraphicsError": "errors",
    "Information": "information",
    "InputError": "errors",
    "Log": "log",
    "ModelPlant": "plant",
    "Options": "options",
    "Parameter": "parameter",
    "ParameterSet": "parameter",
    "Plant": "predictor",
    "Predictor": "predictor",
    "Profile": "profiles",
    "assess": "fit",
    "estimate": "estimation",
    "estimate_from": "multistart",
    "fit_percent": "metrics",
    "halves": "log",
    "loss": "metrics",
    "noise_floor": "noise",
    "profile": "profiles",
    "read_log": "read",
    "residual_tests": "residuals",
    "rms": "metrics",
    "write_log": "write",
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
