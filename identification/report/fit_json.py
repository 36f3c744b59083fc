"""A fit as plain values, for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from identification.estimation.fit import Fit
from identification.quantities import finite_or_none
from identification.report.fit_verdict import fit_verdict


def fit_to_json(fit: Fit) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; what is unknown or infinite is null."""
    e = fit.estimate
    parameters = e.predictor.plant.parameters
    return {
        "parameters": {
            name: {
                "value": e.values[name],
                "std": finite_or_none(std),
                "unit": parameters[name].unit,
                "initial": float(first),
                "at_bound": bool(bound),
                "step_shift": finite_or_none(shift),
            }
            for name, std, first, bound, shift in zip(
                e.space.names, fit.std, e.start, fit.at_bound, fit.step_shift, strict=True
            )
        },
        "combinations": [
            {"name": str(c), "value": value, "std": finite_or_none(std)}
            for c, value, std in fit.combinations
        ],
        "fit_percent": _list(fit.fit_percent),
        "validation_fit_percent": _list(fit.validation_fit_percent),
        "loss": fit.loss,
        "rms": fit.rms,
        "validation_rms": finite_or_none(fit.validation_rms),
        "rms_by_unit": fit.rms_by_unit,
        "validation_rms_by_unit": _finite(fit.validation_rms_by_unit),
        "noise_floor_by_unit": fit.floor_by_unit,
        "validation_expected": finite_or_none(fit.validation_expected),
        "noise_floor": float(np.sqrt(np.mean(fit.floor**2))),
        "iterations": e.jacobians,
        "evaluations": e.evaluations,
        "seconds": e.seconds,
        "status": e.status,
        "verdict": fit_verdict(fit),
    }


def _finite(values: Mapping[str, float] | None) -> dict[str, float | None] | None:
    return None if values is None else {k: finite_or_none(v) for k, v in values.items()}


def _list(values: Iterable[float] | None) -> list[float | None] | None:
    return None if values is None else [finite_or_none(value) for value in values]
