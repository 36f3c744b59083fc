"""A discovery on several records as plain values, for JSON."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from identification.discovery.effect_results import Gap
from identification.effects.effect import Candidate
from identification.model.predictor import Plant
from identification.prediction.model import WindowModel
from identification.prediction.result import NamedByPrediction, RecordsDiscovery, RefittedEffect
from identification.report.curve_nodes import curve_nodes
from identification.report.finding_json import finding_to_json, finite
from identification.report.finding_words import describe_finding


def records_to_json(found: RecordsDiscovery) -> dict[str, Any]:
    """Returns the outcome as plain values; what is unknown or not finite is None."""
    gaps, plant = {"before": found.before, "after": found.after}, found.nominal.plant
    record = {
        "verdict": found.verdict,
        "effects": [_named_to_json(named, plant) for named in found.named],
        "rejected": [_refitted_to_json(effect, plant) for effect in found.rejected],
        "failed": [asdict(failed) for failed in found.failed],
        "unexplained": found.unexplained,
        "share": found.share,
        "gap": {
            "noise_rms": found.noise_rms,
            "noise_rms_by_unit": dict(found.noise_by_unit),
            **{name: _gap_to_json(gap) for name, gap in gaps.items()},
        },
        "records": [
            {
                "file": e.name,
                "role": e.role,
                "before": e.before,
                "after": e.after,
                "before_by_unit": dict(e.before_by_unit),
                "after_by_unit": dict(e.after_by_unit),
            }
            for e in found.errors
        ],
        "shifts": [asdict(s) for s in found.shifts],
        "repeats": list(found.repeats),
        "horizon": found.horizon,
        "timestep": dict(zip(("simulated", "model"), found.steps, strict=True)),
        "input_error": found.input_error,
        "located": [describe_finding(finding) for finding in found.findings],
        "findings": [finding_to_json(finding) for finding in found.findings],
        "nominal": _values_to_json(found.nominal),
        "final": _values_to_json(found.final),
        "options": asdict(found.options),
        "stages": [{"stage": name, "seconds": t} for name, t in found.seconds.items()],
        "seconds": float(sum(found.seconds.values())),
    }
    return {key: finite(value) for key, value in record.items()}


def _gap_to_json(gap: Gap) -> dict[str, Any]:
    return {
        "rms": gap.rms,
        "rms_by_unit": dict(gap.rms_by_unit),
        "fit_percent": gap.fit_percent.tolist(),
    }


def _values_to_json(model: WindowModel) -> dict[str, Any]:
    """Returns fitted values, of one record as `name [record]`, and what effects hold fixed."""
    values, std, shift = {**model.values, **model.fit.values}, model.told_std, model.step_shift
    return {
        name: {"value": value, "std": std.get(name), "step_shift": shift.get(name)}
        for name, value in values.items()
    }


def _refitted_to_json(effect: RefittedEffect, plant: Plant) -> dict[str, Any]:
    seen = effect.prediction
    return {
        **_called(effect.candidate, plant),
        "confidence": effect.confidence,
        "parameters": {
            name: {"value": value, "std": std, "unit": unit}
            for name, (value, std, unit) in effect.parameters.items()
        },
        "gain": effect.criterion,
        "doubt": effect.doubt,
        "proof": {"t": seen.t, "falls": list(seen.falls), "records": list(seen.records)},
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


def _named_to_json(named: NamedByPrediction, plant: Plant) -> dict[str, Any]:
    return {
        **_refitted_to_json(named.effect, plant),
        "rivals": [
            {**_called(r.candidate, plant), "confidence": r.confidence} for r in named.rivals
        ],
        "compared": named.compared,
        "one_of": named.one_of,
        "same_as": named.same_as.name if named.same_as else None,
        "agrees": list(named.agrees),
        "disagrees": list(named.disagrees),
    }  # fmt: skip
