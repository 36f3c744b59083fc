"""The statics of the robot as plain values: what `inca statics --json` prints."""

from __future__ import annotations

from typing import Any

import numpy as np

from inca_mj.statics.interference import Interference
from inca_mj.statics.stiffness import Axes, Modes
from inca_mj.statics.workspace import Workspace
from inca_mj.workflows.statics import StaticAnalysis


def statics_json(found: StaticAnalysis) -> dict[str, Any]:
    """Returns the record; `docs/json.md` explains its keys."""
    held, rest = found.held, found.rest
    return {
        "pose": found.pose.tolist(),
        "load": found.load.tolist(),
        "closure": {
            "rank": found.closure.rank,
            "condition": found.closure.condition,
            "closed": found.closure.closed,
            "margin": found.closure.margin,
        },
        "tension": {
            "low": held.low.tolist(),
            "high": held.high.tolist(),
            "nearest": held.nearest.tolist(),
            "minimum_norm": held.minimum_norm.tolist(),
            "within_limits": held.within.tolist(),
            "current": held.current.tolist(),
        },
        "rest": {
            "pose": rest.pose.tolist(),
            "tension": rest.tension.tolist(),
            "angle": rest.angle.tolist(),
            "stable": rest.stable,
            "friction_band": rest.friction_band.tolist(),
        },
        "stiffness": {
            "drums_locked": found.locked.tolist(),
            "drums_free": found.free.tolist(),
            "against_forces": _axes(found.push),
            "against_torques": _axes(found.twist),
        },
        "modes": {"drums_locked": _modes(found.modes), "drums_free": _modes(found.modes_free)},
        "workspace": None if found.workspace is None else _workspace(found.workspace),
        "interference": {
            "at_pose": _nearness(found.nearness),
            "along": None if found.nearness_along is None else _nearness(found.nearness_along),
        },
        "cable_mass": [
            {
                "rho": e.rho,
                "tension": e.tension,
                "length_error": e.length,
                "angle_error": e.angle,
                "force_error": e.force,
                "force_error_half_weight": e.force_half,
                "sag": e.sag,
                "stiffness_lost": e.stiffness_lost,
                "moved": e.moved,
                "moved_angle": e.moved_angle,
                "line_is_enough": e.line_is_enough,
                "massless_is_enough": e.massless_is_enough,
            }
            for e in found.line_errors
        ],
        "cable_modes": [
            {
                "rho": rho,
                "massless": c.massless.tolist(),
                "added": c.added.tolist(),
                "coupled": c.coupled.tolist(),
                "share": c.share.tolist(),
                "cables": c.cables.tolist(),
                "in_plane": c.in_plane.tolist(),
            }
            for rho, c in zip(found.rho, found.cable_modes, strict=True)
        ],
    }


def _axes(axes: Axes) -> list[dict[str, Any]]:
    rows = zip(axes.values, axes.vectors, axes.words, strict=True)
    return [{"value": float(v), "vector": x.tolist(), "words": words} for v, x, words in rows]


def _modes(modes: Modes) -> list[dict[str, Any]]:
    rows = zip(modes.frequency, modes.words, strict=True)
    return [{"frequency": None if np.isnan(f) else float(f), "words": words} for f, words in rows]


def _workspace(found: Workspace) -> dict[str, Any]:
    return {
        "kind": found.kind,
        "orientation": found.orientation.tolist(),
        "volume": found.volume,
        "std": found.std,
        "points": int(found.margin.size),
        "inside": int(found.inside.sum()),
    }


def _nearness(found: Interference) -> dict[str, Any]:
    pair, at = found.nearest_pair()
    cable, near = found.nearest_to_platform()
    return {
        "poses": len(found.platform),
        "cables": {"pair": list(pair), "distance": float(found.between.min()), "pose": at},
        "platform": {"cable": cable, "clearance": float(found.platform.min()), "pose": near},
        "angle": float(found.angle.min()) if found.angle.size else None,
    }
