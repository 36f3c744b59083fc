"""A fit as plain values, for JSON: of a free run, or of the windows of records."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from identification.estimation.fit import Fit
from identification.model.predictor import Plant
from identification.prediction.records_fit import RecordsFit
from identification.quantities import finite_or_none
from identification.report.fit_verdict import fit_verdict
from identification.report.records_fit_verdict import records_fit_verdict


def fit_to_json(fit: Fit) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; what is unknown or infinite is null."""
    e = fit.estimate
    return {
        "parameters": _parameters(fit, e.predictor.plant, fit.step_shift.tolist()),
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


def records_fit_to_json(found: RecordsFit) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; unknown and infinite numbers are null."""
    model = found.model
    return {
        "parameters": _parameters(found, model.plant, model.step_shift.values()),
        "rms": found.rms,
        "rms_by_unit": found.rms_by_unit,
        "validation_rms": found.unseen_rms[1],
        "validation_rms_by_unit": found.unseen_by_unit,
        "noise_floor": found.noise_rms,
        "noise_floor_by_unit": found.noise_by_unit,
        "seconds": found.seconds,
        "horizon": found.horizon,
        "worse": None if found.worse is None else {
            "rise": (found.unseen_rms[1] / found.unseen_rms[0]) ** 2 - 1, "t": found.worse.t,
        },
        "records": [
            {"file": e.name, "role": e.role, "before": e.before, "after": e.after,
             "before_by_unit": dict(e.before_by_unit), "after_by_unit": dict(e.after_by_unit),
             **_own(found, e.name, e.role)}
            for e in found.errors
        ],
        "verdict": records_fit_verdict(found),
    }  # fmt: skip


def _own(found: RecordsFit, record: str, role: str) -> dict[str, Any]:
    """Returns the own values of a record that confirms; those of a fitted one are parameters."""
    own = found.own.get(record, {}) if role == "confirm" else {}
    values = {n: {"value": v, "std": finite_or_none(std)} for n, (v, std) in own.items()}
    return {"own": values} if values else {}


def _parameters(fit: Fit | RecordsFit, plant: Plant, shifts: Iterable[float]) -> dict[str, Any]:
    """Returns the fitted values by name; a record's own ones are `name [record]`.

    Args:
        fit: of a free run or of windows.
        plant: whose parameters they are.
        shifts: of the values with a quarter of the model's step, in their order.
    """
    units = {p.name: p.unit for p in plant.parameters}
    rows = zip(fit.values.items(), fit.std, fit.start, fit.at_bound, shifts, strict=True)
    return {
        name: {
            "value": value, "std": finite_or_none(std), "unit": units[name.partition(" [")[0]],
            "initial": float(first), "at_bound": bool(bound), "step_shift": finite_or_none(shift),
        }
        for (name, value), std, first, bound, shift in rows
    }  # fmt: skip


def _finite(values: Mapping[str, float] | None) -> dict[str, float | None] | None:
    return None if values is None else {k: finite_or_none(v) for k, v in values.items()}


def _list(values: Iterable[float] | None) -> list[float | None] | None:
    return None if values is None else [finite_or_none(value) for value in values]
