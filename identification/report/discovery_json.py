"""A discovery as plain values, for JSON."""

from __future__ import annotations

from typing import Any

import numpy as np

from identification.discovery.result import Discovery, Named, Tried


def discovery_to_json(found: Discovery) -> dict[str, Any]:
    """The outcome as plain values."""
    gap = {
        name: {
            "rms": g.rms,
            "fit_percent": [float(f) if np.isfinite(f) else None for f in g.fit_percent],
        }
        for name, g in (("before", found.before), ("after", found.after))
    }
    return {
        "verdict": found.verdict,
        "effects": [_effect_json(named) for named in found.named],
        "rejected": [_rejected_json(tried) for tried in found.rejected],
        "unexplained": found.unexplained,
        "gap": {
            "noise_rms": found.noise_rms,
            "disturbance_rms": found.disturbance_rms,
            **gap,
        },
        "located": [*found.located, *found.left],
        "detectable": [
            {"name": d.candidate.effect.name, "where": d.candidate.where, "parameter": d.size,
             "smallest": d.smallest if np.isfinite(d.smallest) else None, "unit": d.unit}
            for d in found.detectable
        ],
        "missing_forces": [
            {"where": m.where, "names": list(m.names), "units": list(m.units),
             "rms": np.sqrt(np.mean(m.force**2, axis=0)).tolist(), "gain": m.gain,
             "share": m.share}
            for m in found.missing
        ],
        "seconds": float(sum(found.seconds.values())),
    }  # fmt: skip


def _rejected_json(tried: Tried) -> dict[str, Any]:
    return {
        "name": tried.candidate.effect.name, "where": tried.candidate.where,
        "parameters": _parameters_json(tried), "gain": tried.gain,
        "proof": {"gain": tried.proof.gain, "t": tried.proof.t, "fall": tried.proof.fall},
    }  # fmt: skip


def _parameters_json(found: Named | Tried) -> dict[str, Any]:
    return {
        name: {"value": value, "std": std if np.isfinite(std) else None, "unit": unit}
        for name, (value, std, unit) in found.parameters.items()
    }


def _effect_json(named: Named) -> dict[str, Any]:
    return {
        "name": named.candidate.effect.name,
        "where": named.candidate.where,
        "confidence": named.confidence,
        "parameters": _parameters_json(named),
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
