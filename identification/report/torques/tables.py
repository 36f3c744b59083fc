"""What torques say of candidates, base parameters and frictions, in words and as rows of tables."""

from __future__ import annotations

import mujoco
import numpy as np

from identification.quantities import quantity
from identification.report.words.errors import listed
from identification.shares import decimal, percent
from identification.torques.evidence import Evidence
from identification.torques.fits import Fitted
from identification.torques.scores import FAR, Score

SHOWN = 8  # candidates that are told


def joint_names(model: mujoco.MjModel) -> tuple[list[str], list[str]]:
    """Returns names of the joints of a model, and the units of their forces."""
    slide = int(mujoco.mjtJoint.mjJNT_SLIDE)
    joints = [int(j) for j in model.dof_jntid]
    return ([model.joint(j).name for j in joints],
            ["N" if int(model.jnt_type[j]) == slide else "N m" for j in joints])  # fmt: skip


def size_words(score: Score) -> str:
    """Returns the sizes of a candidate with their std; of a curve, how far it changes."""
    if score.missing.is_curve:
        return f"it changes by {quantity(score.reach, unit=score.missing.units[0])}"
    sizes = zip(score.missing.sizes, score.size, score.std, score.missing.units, strict=True)
    said = [f"{n.rpartition('.')[2]} = {quantity(v, s, u)}" for n, v, s, u in sizes]
    shapes = [
        f"{n} = {quantity(v, unit=u) if u else decimal(v, 3)}" for n, v, u in score.missing.shape
    ]
    return ", ".join([*said, *shapes])


def called(score: Score) -> str:
    """Returns the name of a candidate, its place, and what it is, in words."""
    what = f" ({score.missing.phrase})" if score.missing.phrase else ""
    return f"{score.missing.title.replace('_', ' ', 2)}{what}"


def centre_words(score: Score) -> str:
    """Returns a sentence on where a load is; "" of what is no load, or where m is not sure."""
    sizes = dict(zip(score.missing.sizes, zip(score.size, score.std, strict=True), strict=True))
    m, σ_m = sizes.get("m", (0.0, 1.0))
    if score.missing.name != "load" or abs(m) <= FAR * σ_m:
        return ""
    at = [  # the std leaves out how m and h go together
        f"{n[2:]} = {quantity(h / m, float(np.hypot(σ, h / m * σ_m) / m), 'm')}"
        for n, (h, σ) in sizes.items() if n.startswith("h_")
    ]  # fmt: skip
    return f" Its centre of mass is at {listed(at)} in the frame of {score.missing.where}."


def chance_words(chance: float) -> str:
    """Returns the chance that the best of all candidates explains as much by luck."""
    return percent(chance) if chance >= 0.01 else "below 1 %"


def base_rows(evidence: Evidence) -> list[tuple[str, str, str, str]]:
    """Returns rows of base parameters: name, value with std, the model's, the difference in std."""
    return _rows(evidence.whole, 0, evidence.base.values)


def friction_rows(evidence: Evidence) -> list[tuple[str, str, str, str]]:
    """Returns rows of frictions: name, value with std, the model's, the difference in std."""
    return _rows(evidence.final, evidence.final.inertial, evidence.friction)


def far_frictions(evidence: Evidence) -> list[tuple[str, str, str]]:
    """Returns name, value with std and the model's value of the frictions that are far from it."""
    rows = friction_rows(evidence)
    return [(name, value, model) for name, value, model, off in rows if abs(float(off)) > FAR]


def _rows(fit: Fitted, first: int, models: np.ndarray) -> list[tuple[str, str, str, str]]:
    """Returns rows of the sizes of a fit from the first one on, beside those of the model."""
    rows = []
    for k, model in enumerate(models, first):
        value, std, unit = fit.fit.θ[k], fit.fit.std[k], fit.units[k]
        off = (value - model) / std if std > 0 else np.nan
        # the model's value has the prefix of the fitted value beside it
        own = quantity(model, unit=unit, like=max(abs(value), std))
        told = quantity(value, std, unit, like=model)
        rows.append((fit.names[k], told, own, f"{off:+z.1f}"))
    return rows


def score_rows(scores: tuple[Score, ...]) -> list[tuple[str, str, str, str, str]]:
    """Returns rows of candidates: title, sizes, fall on unseen blocks, its t, chance."""
    return [
        (called(s), size_words(s), percent(s.fall), f"{s.t:.1f}",
         chance_words(s.chance))
        for s in [s for s in scores if s.is_plausible][:SHOWN]
    ]  # fmt: skip
