"""An effect that was refitted over a horizon, in words: its sizes, and what it predicts."""

from __future__ import annotations

import numpy as np

from identification.model.predictor import Plant
from identification.prediction.result import RefittedEffect
from identification.quantities import fall_words
from identification.report.effect_words import describe_there
from identification.report.records_finding_words import DOUBTS
from identification.report.records_values import value_with_std


def describe_refitted(effect: RefittedEffect, plant: Plant) -> str:
    """Returns an effect of a robot with its sizes, and what it does for unseen records."""
    return (
        f"{describe_there(effect.candidate, plant)}, {sizes_words(effect)}; the unseen mean"
        f" square error {fall_words(effect.prediction.fall)}, t = {effect.prediction.t:z.1f}"
        + (f"; {DOUBTS[effect.doubt]}" if effect.doubt else "")
    )


def sizes_words(effect: RefittedEffect) -> str:
    """Returns sizes and shapes in words with their std, but no shape that no data tell."""
    untold = {s.name for s in effect.candidate.effect.shapes}
    return ", ".join(
        f"{name} not felt" if np.isinf(std) else f"{name} = {value_with_std(v, std, unit)}"
        for name, (v, std, unit) in effect.parameters.items()
        if name not in untold or np.isfinite(std)
    )
