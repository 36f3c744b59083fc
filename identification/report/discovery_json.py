"""A discovery as plain values, for JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from math import isfinite
from typing import Any

import numpy as np

from identification.discovery.effect_results import Gap, NamedEffect, RejectedEffect
from identification.discovery.findings.evidence import DoubtfulEffect, OversizedEffect
from identification.discovery.findings.finding import Finding
from identification.discovery.result import Discovery
from identification.report.finding_words import describe_finding


def discovery_to_json(found: Discovery) -> dict[str, Any]:
    """The outcome as plain values; what is unknown or not finite is None."""
    findings = (*found.located, *found.findings)
    record = {
        "verdict": found.verdict,
        "effects": [_named_to_json(named) for named in found.named],
        "rejected": [_rejected_to_json(rejected) for rejected in found.rejected],
        "unexplained": found.unexplained,
        "gap": {
            "noise_rms": found.noise_rms,
            "disturbance_rms": found.disturbance_rms,
            "before": _gap_to_json(found.before),
            "after": _gap_to_json(found.after),
        },
        "located": [describe_finding(finding) for finding in findings],
        "findings": [finding_to_json(finding) for finding in findings],
        "detectable": [
            {"name": d.candidate.effect.name, "where": d.candidate.where, "parameter": d.size,
             "smallest": d.smallest, "unit": d.unit}
            for d in found.detectable
        ],
        "missing_forces": [
            {"where": m.where, "names": m.names, "units": m.units,
             "rms": np.sqrt(np.mean(m.force**2, axis=0)).tolist(), "gain": m.gain,
             "share": m.share}
            for m in found.missing_forces
        ],
        "options": asdict(found.options),
        "seconds": float(sum(found.seconds.values())),
    }  # fmt: skip
    return {key: finite(value) for key, value in record.items()}


def finding_to_json(finding: Finding) -> dict[str, Any]:
    """A finding as plain values: its kind, and the numbers and names of its evidence."""
    evidence = finding.evidence
    if isinstance(evidence, DoubtfulEffect):
        numbers = _rejected_to_json(evidence.rejected)
    elif isinstance(evidence, OversizedEffect):
        numbers = _oversized_to_json(evidence)
    else:
        numbers = asdict(evidence)
    return {"kind": finding.kind.value, **numbers}


def finite(value: Any) -> Any:
    """Plain values with lists for tuples, and None for every number that is not finite."""
    if isinstance(value, dict):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not isfinite(value) else value


def _gap_to_json(gap: Gap) -> dict[str, Any]:
    return {"rms": gap.rms, "fit_percent": gap.fit_percent.tolist()}


def _rejected_to_json(rejected: RejectedEffect) -> dict[str, Any]:
    proof = rejected.proof
    return {
        "name": rejected.candidate.effect.name, "where": rejected.candidate.where,
        "parameters": _parameters_to_json(rejected.parameters), "gain": rejected.gain,
        "proof": {"gain": proof.gain, "t": proof.t, "fall": proof.fall},
    }  # fmt: skip


def _oversized_to_json(evidence: OversizedEffect) -> dict[str, Any]:
    score = evidence.score
    sizes = zip(score.candidate.effect.sizes, score.size, score.std, strict=True)
    return {
        "name": score.candidate.effect.name, "where": score.candidate.where,
        "parameters": {
            s.name: {"value": float(value), "std": float(std), "unit": s.unit,
                     "limit": evidence.limits.get(s.name)}
            for s, value, std in sizes
        },
        "gain": score.gain,
    }  # fmt: skip


def _parameters_to_json(parameters: Mapping[str, tuple[float, float, str]]) -> dict[str, Any]:
    return {
        name: {"value": value, "std": std, "unit": unit}
        for name, (value, std, unit) in parameters.items()
    }


def _named_to_json(named: NamedEffect) -> dict[str, Any]:
    return {
        "name": named.candidate.effect.name,
        "where": named.candidate.where,
        "confidence": named.confidence,
        "parameters": _parameters_to_json(named.parameters),
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
        "advice": named.advice or None,
        "proof": {"gain": named.proof.gain, "t": named.proof.t, "share": named.proof.share},
    }  # fmt: skip
