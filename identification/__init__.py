"""Identification of a MuJoCo model from logs of the robot it stands for.

The public names; each is imported when it is first asked for, so that reading a log needs no
simulator and a bad graphics setting cannot stop it.
"""

from identification.lazy import lazy

_PUBLIC = {
    "DivergenceError": "errors",
    "Estimate": "estimation.estimation",
    "Experiment": "estimation.experiment",
    "Fit": "estimation.fit",
    "GraphicsError": "errors",
    "Information": "estimation.information",
    "InputError": "errors",
    "Log": "logs.log",
    "ModelPlant": "model.plant",
    "Options": "estimation.options",
    "Parameter": "model.parameter",
    "ParameterSet": "model.parameter",
    "Plant": "model.predictor",
    "Predictor": "model.predictor",
    "Profile": "estimation.profiles",
    "assess": "estimation.fit",
    "estimate": "estimation.estimation",
    "estimate_from": "estimation.multistart",
    "fit_percent": "estimation.metrics",
    "halves": "logs.log",
    "loss": "estimation.metrics",
    "noise_floor": "logs.noise",
    "profile": "estimation.profiles",
    "read_log": "logs.read",
    "residual_tests": "estimation.residuals",
    "rms": "estimation.metrics",
    "write_log": "logs.write",
}
__all__ = list(_PUBLIC)
__getattr__, __dir__ = lazy(__name__, _PUBLIC)
