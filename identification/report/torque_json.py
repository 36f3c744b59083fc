"""What torques say of a robot, as plain values."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from identification.quantities import plain
from identification.report.torque_words import SHOWN, joint_names
from identification.torques.evidence import Evidence
from identification.torques.fits import Fitted
from identification.torques.scores import Score

FITS = ("whole", "model", "final")


def evidence_to_json(evidence: Evidence, model: mujoco.MjModel) -> dict[str, Any]:
    """Returns what torques say as plain values."""
    names, units = joint_names(model)
    joints = {}
    for j, name in enumerate(names):
        of = {
            fit: {
                "residual": float(getattr(evidence, fit).fit.σ[j]),
                "unseen": float(evidence.unseen[k, j]),
            }
            for k, fit in enumerate(FITS)
        }
        joints[name] = {"unit": units[j], **of}
    return plain({
        "joints": joints,
        "base_parameters": _values(
            evidence.whole, np.append(evidence.base.values, evidence.friction), evidence.other
        ),
        "values": _values(evidence.final, None, None),
        "named": [_score(s) for s in evidence.named],
        "scores": [_score(s) for s in evidence.scores[:SHOWN]],
        "rest": [_score(s) for s in evidence.rest[:SHOWN]],
        "differences": [_score(s) for s in evidence.differences[:SHOWN]],
        "asked": evidence.asked,
        "inconsistent": [evidence.base.names[k] for k in evidence.inconsistent],
        "bands": {r.name: r.band for r in evidence.equations.rows},
    })  # fmt: skip


def _values(
    fit: Fitted, model: np.ndarray | None, other: np.ndarray | None
) -> dict[str, dict[str, Any]]:
    out = {}
    for k, name in enumerate(fit.names):
        one: dict[str, Any] = {"value": fit.fit.θ[k], "std": fit.fit.std[k], "unit": fit.units[k]}
        if model is not None and k < len(model):
            one["model"] = model[k]
        if other is not None:
            one["narrower"] = other[k]
        out[name] = one
    return out


def _score(score: Score) -> dict[str, Any]:
    return {
        "name": score.missing.name, "where": score.missing.where,
        "sizes": {
            n: {"value": v, "std": s, "unit": u}
            for n, v, s, u in zip(score.missing.sizes, score.size, score.std, score.missing.units,
                                  strict=True)
        },
        "shape": {n: v for n, v, _ in score.missing.shape}, "fall": score.fall, "t": score.t,
        "held_t": score.held_t, "chance": score.chance, "proven": score.is_proven,
    }  # fmt: skip
