"""A fit as plain values, for JSON: of a free run, or of the windows of records."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from identification.estimation.fit import Fit
from identification.model.predictor import Plant
from identification.quantities import plain, plain_fields
from identification.report.fit.verdict import fit_verdict

if TYPE_CHECKING:  # slow to import
    from identification.prediction.records_fit import RecordsFit


def fit_to_json(fit: Fit | RecordsFit) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; what is unknown or infinite is null."""
    if not isinstance(fit, Fit):
        return _of_records(fit)
    e = fit.estimate
    return {
        "parameters": _parameters(fit, e.predictor.plant, fit.step_shift.tolist()),
        "combinations": [
            plain({"name": str(name), "value": value, "std": std})
            for name, value, std in fit.combinations
        ],
        **plain_fields(
            fit, "fit_percent", "validation_fit_percent", "loss", "rms", "validation_rms",
            "rms_by_unit", "validation_rms_by_unit", "validation_expected",
            noise_floor_by_unit="floor_by_unit",
        ),
        "noise_floor": float(np.sqrt(np.mean(fit.floor**2))),
        **plain_fields(e, "evaluations", "seconds", "status", iterations="jacobians"),
        "verdict": fit_verdict(fit),
    }  # fmt: skip


def _of_records(found: RecordsFit) -> dict[str, Any]:
    before, after = found.unseen_rms
    rise = (after / before) ** 2 - 1 if found.worse else 0.0
    records = []
    for e in found.errors:
        told = plain_fields(e, "role", "before", "after", "before_by_unit", "after_by_unit",
                            file="name")  # fmt: skip
        if e.role == "confirm" and found.own.get(e.name):  # those of a fitted one are parameters
            own = found.own[e.name].items()
            told["own"] = {n: plain({"value": value, "std": std}) for n, (value, std) in own}
        records.append(told)
    return {
        "parameters": _parameters(found, found.model.plant, found.model.step_shift.values()),
        **plain_fields(
            found, "rms", "rms_by_unit", "seconds", "horizon", noise_floor="noise_rms",
            noise_floor_by_unit="noise_by_unit", validation_rms_by_unit="unseen_by_unit",
        ),
        "validation_rms": plain(after),
        "worse": None if found.worse is None else plain({"rise": rise, "t": found.worse.t}),
        "records": records,
        "verdict": fit_verdict(found),
    }  # fmt: skip


def _parameters(fit: Fit | RecordsFit, plant: Plant, shifts: Iterable[float]) -> dict[str, Any]:
    """Returns the fitted values by name; a record's own ones are `name [record]`."""
    units = {p.name: p.unit for p in plant.parameters}
    rows = zip(fit.values.items(), fit.std, fit.start, fit.at_bound, shifts, strict=True)
    return {
        name: plain({
            "value": value, "std": std, "unit": units[name.partition(" [")[0]], "initial": first,
            "at_bound": bool(bound), "step_shift": shift,
        })
        for (name, value), std, first, bound, shift in rows
    }  # fmt: skip
