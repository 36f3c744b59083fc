"""Effects that the fitted noise may still hide, and how large each of them may be.

    most  = |η̂| + 1.96 std(η̂)            η̂ as it would be fitted, with the noise most likely then
    taken = 1 - (ρ_j σ_j)²/(ρ σ)²         share of the power of the inputs' error

A noise model takes what repeats like an error of the inputs for one: a hysteresis of the springs
pulls a drive as a wrong current does. With the effect in the model the inputs would have to err by
less, and `taken` says by how much.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.chances import normal_level
from identification.discovery.effect_results import Hidden
from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.significance import is_plausible
from identification.kalman.noise_fit import NoiseLevel

NORMAL_QUANTILE = normal_level(0.025)  # of a two-sided interval of 95 %


def list_hidden(
    scores: Sequence[Score], level: NoiseLevel, options: DiscoveryOptions
) -> tuple[Hidden, ...]:
    """Returns the effects that the noise may hide, those that would explain most first.

    Of each effect the place and the shape count with which it would explain most. An effect that
    would explain nothing, or of which the log can say no size that is believed, is left out.

    Args:
        scores: of the candidates that the model does not have, on it, the best first.
        level: the fitted noise.
        options: the sizes that are believed.
    """
    best: dict[str, Score] = {}
    for s in scores:
        if s.gain > 0 and is_plausible(s.candidate, s.size, options):
            best.setdefault(s.candidate.effect.name, s)
    return tuple(_hidden(s, level) for s in best.values() if _is_bounded(s, options))


def _most(s: Score) -> np.ndarray:
    """Returns the largest size of each kind that the log does not contradict, shape (m,)."""
    most: np.ndarray = np.abs(s.size) + NORMAL_QUANTILE * s.std
    return most


def _is_bounded(s: Score, options: DiscoveryOptions) -> bool:
    largest = np.array([size.largest for size in s.candidate.effect.sizes])
    return bool(np.all(_most(s) <= options.size_factor * largest))


def _hidden(s: Score, level: NoiseLevel) -> Hidden:
    sizes = zip(s.candidate.effect.sizes, s.size, _most(s), strict=True)
    with_it, without = s.level.input_std, level.input_std
    return Hidden(
        candidate=s.candidate,
        sizes={size.name: (float(value), float(most), size.unit) for size, value, most in sizes},
        taken=float(max(0.0, 1 - (with_it / without) ** 2)) if without > 0 else 0.0,
        gain=s.gain,
    )
