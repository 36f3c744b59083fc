"""A discovery as plain values, for JSON: the same keys whichever search has found it."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from identification.discovery.effect_results import Gap, NamedEffect, RecordError
from identification.discovery.fitted import Fitted
from identification.discovery.result import Discovery
from identification.effects.effect import Candidate
from identification.model.predictor import Plant
from identification.report.curve_nodes import curve_nodes
from identification.report.finding_json import (
    finding_to_json,
    finite,
    parameters_to_json,
    proof_to_json,
    rejected_to_json,
)
from identification.report.finding_words import describe_finding
from identification.windows.coarse import steps_of


def discovery_to_json(found: Discovery) -> dict[str, Any]:
    """Returns the outcome as plain values; what is unknown or not finite is None."""
    findings, plant = (*found.located, *found.findings), found.final.plant
    record = {
        "verdict": found.verdict,
        "effects": [_named_to_json(named, plant) for named in found.named],
        "rejected": [
            {**rejected_to_json(r), **_called(r.candidate, plant)} for r in found.rejected
        ],
        "failed": [asdict(failed) for failed in found.failed],
        "unexplained": found.unexplained,
        "share": found.share,
        "gap": {
            "noise_rms": found.noise_rms,
            "disturbance_rms": found.disturbance_rms,
            "noise_rms_by_unit": dict(found.noise_by_unit),
            "disturbance_rms_by_unit": dict(found.disturbance_by_unit),
            "before": _gap_to_json(found.before),
            "after": _gap_to_json(found.after),
        },
        "records": [_record_to_json(error) for error in found.errors],
        "shifts": [asdict(shift) for shift in found.shifts],
        "repeats": list(found.repeats),
        "horizon": found.horizon,
        "timestep": dict(zip(("simulated", "model"), steps_of(found.nominal.plant), strict=True)),
        "input_error": found.input_error,
        "located": [describe_finding(finding) for finding in findings],
        "findings": [finding_to_json(finding) for finding in findings],
        "nominal": _values_to_json(found.nominal),
        "final": _values_to_json(found.final),
        "detectable": [
            {"name": d.name, "where": d.where, "parameter": d.size, "smallest": d.smallest,
             "unit": d.unit}
            for d in found.detectable
        ],
        "hidden": [
            {"name": h.name, "where": h.where,
             "sizes": [{"parameter": n, "value": v, "most": most, "unit": unit}
                       for n, (v, most, unit) in h.sizes.items()],
             "taken": h.taken, "gain": h.gain}
            for h in found.hidden
        ],
        "missing_forces": [
            {"where": m.where, "names": m.names, "units": m.units,
             "rms": np.sqrt(np.mean(m.force**2, axis=0)).tolist(), "gain": m.gain,
             "share": m.share}
            for m in found.missing_forces
        ],
        "options": asdict(found.options),
        "moves": list(found.moves),
        "stages": [{"stage": name, "seconds": t} for name, t in found.seconds.items()],
        "seconds": float(sum(found.seconds.values())),
    }  # fmt: skip
    return {key: finite(value) for key, value in record.items()}


def _gap_to_json(gap: Gap) -> dict[str, Any]:
    return {
        "rms": gap.rms, "fit_percent": gap.fit_percent.tolist(),
        "rms_by_unit": dict(gap.rms_by_unit),
    }  # fmt: skip


def _record_to_json(error: RecordError) -> dict[str, Any]:
    return {
        "file": error.name, "role": error.role, "before": error.before, "after": error.after,
        "before_by_unit": dict(error.before_by_unit) or None,
        "after_by_unit": dict(error.after_by_unit) or None,
    }  # fmt: skip


def _values_to_json(model: Fitted) -> dict[str, Any]:
    """Returns fitted values, of one record as `name [record]`, and what effects hold fixed."""
    std, finer = model.told_std, model.finer
    shift = {} if finer is None else dict(zip(std, finer.values.tolist(), strict=True))
    return {
        name: {"value": value, "std": std.get(name), "step_shift": shift.get(name)}
        for name, value in model.told_values.items()
    }


def _called(candidate: Candidate, plant: Plant) -> dict[str, Any]:
    """Returns name and place; a curve of the data has no name, but says what it depends on."""
    effect, where = candidate.effect, candidate.where
    if not effect.is_curve:
        return {"name": effect.name, "where": where}
    nodes = curve_nodes(candidate, plant)
    each = {
        f"joint {n.joint}": {"reads": n.reads, "nodes": n.at.tolist(), "nodes_unit": n.unit}
        for n in nodes
    }
    return {
        "name": "unlisted", "where": where, "depends_on": nodes[0].depends_on,
        **({"joints": each} if len(nodes) > 1 else each[f"joint {nodes[0].joint}"]),
    }  # fmt: skip


def _named_to_json(named: NamedEffect, plant: Plant) -> dict[str, Any]:
    proof = named.proof
    return {
        **_called(named.candidate, plant),
        "confidence": named.confidence,
        "parameters": parameters_to_json(named.parameters),
        "rivals": [
            {**_called(r.candidate, plant), "confidence": r.confidence} for r in named.rivals
        ],
        "compared": named.compared,
        "one_of": named.one_of,
        "same_as": named.same_as.name if named.same_as else None,
        "bic_gain": named.bic_gain,
        "evidence": named.evidence,
        "retuned": None if named.retuned is None else asdict(named.retuned),
        "outside": None if named.outside is None else asdict(named.outside),
        "advice": named.advice or None,
        "proof": proof_to_json(proof),
        "agrees": list(proof.agrees),
        "disagrees": list(proof.disagrees),
    }
