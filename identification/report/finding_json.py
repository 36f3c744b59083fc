"""Findings, parameters and rejected effects as plain values, for JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from math import isfinite
from typing import Any

from identification.discovery.effect_results import Proof, RejectedEffect
from identification.discovery.findings.evidence import DoubtfulEffect, OversizedEffect
from identification.discovery.findings.finding import Finding


def finding_to_json(finding: Finding) -> dict[str, Any]:
    """Returns a finding as plain values: its kind, and the numbers and names of its evidence."""
    evidence = finding.evidence
    if isinstance(evidence, DoubtfulEffect):
        numbers = rejected_to_json(evidence.rejected)
    elif isinstance(evidence, OversizedEffect):
        numbers = _oversized_to_json(evidence)
    else:
        numbers = asdict(evidence)
    return {"kind": finding.kind.value, **numbers}


def finite(value: Any) -> Any:
    """Returns plain values with lists for tuples, and None for every number that is not finite."""
    if isinstance(value, dict):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not isfinite(value) else value


def rejected_to_json(rejected: RejectedEffect) -> dict[str, Any]:
    """Returns an effect that was refitted and not believed, as plain values."""
    return {
        "name": rejected.name, "where": rejected.where, "confidence": rejected.confidence,
        "parameters": parameters_to_json(rejected.parameters), "bic_gain": rejected.bic_gain,
        "evidence": rejected.evidence, "doubt": rejected.doubt,
        "proof": proof_to_json(rejected.proof),
        "outside": None if rejected.outside is None else asdict(rejected.outside),
    }  # fmt: skip


def proof_to_json(proof: Proof) -> dict[str, Any]:
    """Returns what an effect does for unseen samples, as plain values."""
    return {
        "test": proof.test, "t": proof.t, "chance": proof.chance, "gain": proof.gain,
        "share": proof.share, "fall": proof.fall, "falls": list(proof.falls),
        "records": list(proof.records),
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
        "gain": score.explains,
    }  # fmt: skip


def parameters_to_json(parameters: Mapping[str, tuple[float, float, str]]) -> dict[str, Any]:
    """Returns parameters as plain values: value, std and unit by name."""
    return {
        name: {"value": value, "std": std, "unit": unit}
        for name, (value, std, unit) in parameters.items()
    }
