"""A discovery as plain values, for JSON."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from identification.discovery.effect_results import Gap, NamedEffect
from identification.discovery.result import Discovery
from identification.prediction.result import RecordsDiscovery
from identification.report.finding_json import (
    finding_to_json,
    finite,
    outside_to_json,
    parameters_to_json,
    rejected_to_json,
)
from identification.report.finding_words import describe_finding
from identification.report.record_gaps import record_gaps
from identification.report.records_json import records_to_json


def discovery_to_json(found: Discovery | RecordsDiscovery) -> dict[str, Any]:
    """Returns the outcome as plain values; what is unknown or not finite is None."""
    if isinstance(found, RecordsDiscovery):
        return records_to_json(found)
    findings = (*found.located, *found.findings)
    record = {
        "verdict": found.verdict,
        "effects": [_named_to_json(named) for named in found.named],
        "rejected": [rejected_to_json(rejected) for rejected in found.rejected],
        "failed": [asdict(failed) for failed in found.failed],
        "unexplained": found.unexplained,
        "gap": {
            "noise_rms": found.noise_rms,
            "disturbance_rms": found.disturbance_rms,
            "noise_rms_by_unit": dict(found.noise_by_unit),
            "disturbance_rms_by_unit": dict(found.disturbance_by_unit),
            "before": _gap_to_json(found.before),
            "after": _gap_to_json(found.after),
        },
        "records": record_gaps(found),
        "located": [describe_finding(finding) for finding in findings],
        "findings": [finding_to_json(finding) for finding in findings],
        "detectable": [
            {"name": d.candidate.effect.name, "where": d.candidate.where, "parameter": d.size,
             "smallest": d.smallest, "unit": d.unit}
            for d in found.detectable
        ],
        "hidden": [
            {"name": h.candidate.effect.name, "where": h.candidate.where,
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
        "stages": [{"stage": name, "seconds": t} for name, t in found.seconds.items()],
        "seconds": float(sum(found.seconds.values())),
    }  # fmt: skip
    return {key: finite(value) for key, value in record.items()}


def _gap_to_json(gap: Gap) -> dict[str, Any]:
    return {
        "rms": gap.rms, "fit_percent": gap.fit_percent.tolist(),
        "rms_by_unit": dict(gap.rms_by_unit),
    }  # fmt: skip


def _named_to_json(named: NamedEffect) -> dict[str, Any]:
    return {
        "name": named.candidate.effect.name,
        "where": named.candidate.where,
        "confidence": named.confidence,
        "parameters": parameters_to_json(named.parameters),
        "rivals": [
            {"name": r.candidate.effect.name, "where": r.candidate.where,
             "confidence": r.confidence}
            for r in named.rivals
        ],
        "one_of": named.one_of,
        "retuned": {
            "parameter": named.retuned.parameter, "distance": named.retuned.distance,
            "confidence": named.retuned.confidence,
        },
        "outside": outside_to_json(named.outside),
        "advice": named.advice or None,
        "proof": {
            "gain": named.proof.gain, "t": named.proof.t, "chance": named.proof.chance,
            "share": named.proof.share,
        },
        "agrees": list(named.proof.agrees), "disagrees": list(named.proof.disagrees),
    }  # fmt: skip
