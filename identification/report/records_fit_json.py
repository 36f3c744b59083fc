"""A fit of the windows of records as plain values, for JSON, with the keys of a fit."""

from __future__ import annotations

from typing import Any

from identification.prediction.records_fit import RecordsFit
from identification.quantities import finite_or_none
from identification.report.records_fit_verdict import records_fit_verdict


def records_fit_to_json(found: RecordsFit) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; unknown and infinite numbers are null."""
    rows = zip(found.values.items(), found.std, found.start, found.at_bound, strict=True)
    shift = found.model.step_shift
    units = {p.name: p.unit for p in found.model.plant.parameters}
    return {
        "parameters": {
            name: {"value": value, "std": finite_or_none(std),
                   "unit": units[name.partition(" [")[0]], "initial": float(first),
                   "at_bound": bool(bound), "step_shift": finite_or_none(shift[name])}
            for (name, value), std, first, bound in rows
        },
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
