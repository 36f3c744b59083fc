"""Identification of a MuJoCo model from logs of the robot it stands for.

The public names; each is imported when it is first asked for, so that reading a log needs no
simulator and a bad graphics setting cannot stop it.
"""

from identification.lazy import lazy

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
__getattr__, __dir__ = lazy(__name__, _PUBLIC)
