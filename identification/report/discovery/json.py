"""A discovery as plain values, for JSON: the same keys whichever search has found it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from identification.discovery.effect_results import NamedEffect, Proof, RejectedEffect
from identification.discovery.findings.evidence import (
    DoubtfulEffect,
    OversizedEffect,
    UntriedEffect,
)
from identification.discovery.findings.finding import Finding
from identification.discovery.fitted import Fitted
from identification.discovery.result import Discovery
from identification.effects.effect import Candidate
from identification.model.predictor import Plant
from identification.quantities import plain, plain_fields
from identification.report.discovery.finding_words import describe_finding
from identification.report.discovery.horizon_gap import find_gap
from identification.report.discovery.missing_place import find_place
from identification.report.discovery.named_words import curve_nodes
from identification.report.discovery.verdict import discovery_verdict
from identification.report.words.parts import parts_to_json
from identification.report.words.rest import resting
from identification.windows.coarse import steps_of

GAP = ("rms", "fit_percent", "rms_by_unit")
PROOF = ("test", "t", "chance", "gain", "share", "fall", "falls", "records")
NAMED = (
    "confidence", "compared", "one_of", "bic_gain", "evidence", "retuned", "outside",
    "smooth_share", "neighbour",
)  # fmt: skip
REJECTED = ("name", "where", "confidence", "bic_gain", "evidence", "doubt", "luck", "outside")


def discovery_to_json(found: Discovery) -> dict[str, Any]:
    """Returns the outcome as plain values; what is unknown or not finite is None."""
    findings, plant = (*found.located, *found.findings), found.final.plant
    return {
        "verdict": found.verdict,
        "sentences": discovery_verdict(found),
        "effects": [_named_to_json(named, plant) for named in found.named],
        "rejected": [
            {**_rejected_to_json(r), **_called(r.candidate, plant)} for r in found.rejected
        ],
        **plain_fields(found, "failed", "unexplained", "share"),
        **plain_fields(found, "smooth_share", "smooth_by_joint"),
        "gap": {
            **plain_fields(
                found, "noise_rms", "disturbance_rms", noise_rms_by_unit="noise_by_unit",
                noise_rms_by_output="noise_by_output",
                disturbance_rms_by_unit="disturbance_by_unit",
            ),
            "before": plain_fields(found.before, *GAP),
            "after": plain_fields(found.after, *GAP),
            "doubtful": found.doubtful and plain_fields(found.doubtful, *GAP),
        },
        "records": [
            {**plain_fields(e, "role", "before", "after", file="name"),
             "before_by_unit": plain(e.before_by_unit) or None,
             "after_by_unit": plain(e.after_by_unit) or None}
            for e in found.errors
        ],
        "differences": [
            {**plain_fields(d, "name", "where", "spread"),
             "parameters": _parameters_to_json({n: (*v, d.unit) for n, v in d.values.items()})}
            for d in found.differences
        ],
        "torques": [
            {**plain_fields(o, "name", "where", "fall", "t", "chance", "standing", "doubt", "free"),
             "proven": o.is_proven, "named": o.is_named, "first": o.is_first,
             "sizes": _parameters_to_json(o.sizes)}
            for o in found.torques
        ],
        "torques_refused": found.torques_refused,
        "parts": parts_to_json(found),
        **plain_fields(found, "shifts", "repeats", "horizon"),
        "resting": resting(found),
        "timestep": dict(zip(("simulated", "model"), steps_of(found.nominal.plant), strict=True)),
        "input_error": plain(found.input_error),
        "located": [describe_finding(finding) for finding in findings],
        "findings": [finding_to_json(finding) for finding in findings],
        "nominal": _values_to_json(found.nominal),
        "final": _values_to_json(found.final),
        "detectable": [
            plain_fields(d, "name", "where", "smallest", "unit", parameter="size")
            for d in found.detectable
        ],
        "hidden": [
            {**plain_fields(h, "name", "where", "taken", "gain"),
             "sizes": [plain({"parameter": n, "value": v, "most": most, "unit": unit})
                       for n, (v, most, unit) in h.sizes.items()]}
            for h in found.hidden
        ],
        "missing_forces": [
            {**plain_fields(m, "where", "names", "units", "gain", "share"),
             "rms": plain(np.sqrt(np.mean(m.force**2, axis=0)))}
            for m in found.missing_forces
        ],
        "missing_place": plain(find_place(found)),
        "fails": _fails_to_json(found),
        **plain_fields(found, "options", "moves", "cut_short"),
        "stages": [{"stage": name, "seconds": t} for name, t in found.seconds.items()],
        "seconds": found.took,
    }  # fmt: skip


def _fails_to_json(found: Discovery) -> dict[str, Any] | None:
    """Returns where the models fail over a horizon as plain values; None along a free run."""
    gap = find_gap(found)
    if gap is None:
        return None
    return {
        "outputs": plain(gap.outputs), "lengths": plain(gap.lengths),
        "windows": [
            {**plain_fields(w, "record", "output", "ratio"), "begin": float(w.time[0])}
            for w in gap.windows
        ],
        "forces": [
            {"force": plain(f.force[0]), "std": plain(f.std[0]),
             "falling": {"force": plain(f.force[1]), "std": plain(f.std[1])}
             if len(f.force) > 1 else None,
             **plain_fields(f, "unit", "fall", "chance"),
             **plain_fields(f.nodes, "joint", "depends_on", "reads", nodes="at",
                            nodes_unit="unit")}
            for f in gap.needed.forces
        ],
    }  # fmt: skip


def finding_to_json(finding: Finding) -> dict[str, Any]:
    """Returns a finding as plain values: its kind, and the numbers and names of its evidence."""
    evidence = finding.evidence
    if isinstance(evidence, DoubtfulEffect):
        numbers = _rejected_to_json(evidence.rejected)
    elif isinstance(evidence, UntriedEffect):
        c = evidence.score.candidate
        numbers = {"name": c.effect.name, "where": c.where}
    elif isinstance(evidence, OversizedEffect):
        score, c = evidence.score, evidence.score.candidate
        sizes = {
            s.name: {"value": value, "std": std, "unit": s.unit,
                     "limit": evidence.limits.get(s.name)}
            for s, value, std in zip(c.effect.sizes, score.size, score.std, strict=True)
        }  # fmt: skip
        numbers = plain(
            {"name": c.effect.name, "where": c.where, "gain": score.explains, "parameters": sizes}
        )
    else:
        numbers = plain(evidence)
    return {"kind": finding.kind.value, **numbers}


def _named_to_json(named: NamedEffect, plant: Plant) -> dict[str, Any]:
    return {
        **_called(named.candidate, plant),
        **plain_fields(named, *NAMED),
        "parameters": _parameters_to_json(named.parameters),
        "rivals": [
            {
                **_called(r.candidate, plant),
                "confidence": r.confidence,
                # sizes and shapes of a rival in its own fit, by the plant's names
                "values": {
                    n: plain(v)
                    for n, v in r.values.items()
                    if n in (*r.candidate.sizes, *r.candidate.fixed)
                },
                "parameters": _parameters_to_json(r.parameters),
            }
            for r in named.rivals
        ],
        "same_as": named.same_as.name if named.same_as else None,
        "same_as_parameters": _parameters_to_json(named.twin.parameters) if named.twin else None,
        "advice": named.advice or None,
        **_proofs_to_json(named.proof),
        **plain_fields(named.proof.told, "agrees", "disagrees"),
    }


def _rejected_to_json(rejected: RejectedEffect) -> dict[str, Any]:
    """Returns an effect that was refitted and not believed, as plain values."""
    return {
        **plain_fields(rejected, *REJECTED),
        "parameters": _parameters_to_json(rejected.parameters),
        **_proofs_to_json(rejected.proof),
    }


def _proofs_to_json(proof: Proof) -> dict[str, Any]:
    """Returns the proof on samples that are told of, and that by which the search decided."""
    return {"proof": plain_fields(proof.told, *PROOF), "decided": plain_fields(proof, *PROOF)}


def _parameters_to_json(parameters: Mapping[str, tuple[float, float, str]]) -> dict[str, Any]:
    return {
        name: plain({"value": value, "std": std, "unit": unit})
        for name, (value, std, unit) in parameters.items()
    }


def _values_to_json(model: Fitted) -> dict[str, Any]:
    """Returns fitted values, of one record as `name [record]`, and what effects hold fixed."""
    std, finer = model.told_std, model.finer
    shift = {} if finer is None else dict(zip(std, finer.values, strict=True))
    return {
        name: plain({"value": value, "std": std.get(name), "step_shift": shift.get(name)})
        for name, value in model.told_values.items()
    }


def _called(candidate: Candidate, plant: Plant) -> dict[str, Any]:
    """Returns name and place; a curve of the data has no name, but says what it depends on."""
    effect, where = candidate.effect, candidate.where
    if not effect.is_curve:
        return {"name": effect.name, "where": where}
    nodes = curve_nodes(candidate, plant)
    each = {
        f"joint {n.joint}": plain_fields(n, "reads", nodes="at", nodes_unit="unit") for n in nodes
    }
    return {
        "name": "unlisted", "where": where, "depends_on": nodes[0].depends_on,
        **({"joints": each} if len(nodes) > 1 else each[f"joint {nodes[0].joint}"]),
    }  # fmt: skip
