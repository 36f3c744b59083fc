"""Which scores are beyond chance, and what the noise may hide.

    chance of the best of n candidates <= n p
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
from identification.effects.effect import Candidate
from identification.innovations.scoring.scores import Score
from identification.kalman.noise_fit import NoiseLevel

NORMAL_QUANTILE = normal_level(0.025)  # of a two-sided interval of 95 %


def select_significant(scores: Sequence[Score], options: DiscoveryOptions) -> list[Score]:
    """Returns plausible scores beyond chance: the best shape of each effect at each place."""
    count = len(scores)
    likely = [s for s in scores if correct_p_value(s, count) < options.significance]
    return select_plausible(likely, options)


def select_plausible(scores: Sequence[Score], options: DiscoveryOptions) -> list[Score]:
    """Returns scores with plausible sizes: the best shape of each effect at each place."""
    each: dict[tuple[str, str], Score] = {}
    for s in sorted(scores, key=gain_of_whole, reverse=True):
        if is_plausible(s.candidate, s.size, options) and s.gain > 0:
            each.setdefault((s.candidate.effect.name, s.candidate.where), s)
    return sorted(each.values(), key=lambda s: -s.gain)


def gain_of_whole(s: Score) -> float:
    """Returns the gain of a score; less where an effect with only one possible size has another.

    The score of such an effect (a limit) estimates its size; the farther the estimate is from the
    one size, the worse is its shape.
    """
    fixed = [size.present for size in s.candidate.effect.sizes]
    if fixed[0] is None or s.size[0] <= 0:
        return s.gain
    return s.gain * float(np.exp(-abs(np.log(s.size[0] / fixed[0]))))


def is_plausible(candidate: Candidate, size: np.ndarray, options: DiscoveryOptions) -> bool:
    """Returns whether sizes have a sign that physics admits and a magnitude that is believed."""
    return is_possible(candidate, size) and not is_oversized(candidate, size, options)


def is_possible(candidate: Candidate, size: np.ndarray) -> bool:
    """Returns whether all sizes have a sign that physics admits."""
    return all(s.sign * v >= 0 for v, s in zip(size, candidate.effect.sizes, strict=True))


def is_oversized(candidate: Candidate, size: np.ndarray, options: DiscoveryOptions) -> bool:
    """Returns whether a size is beyond what is believed."""
    sizes = zip(size, candidate.effect.sizes, strict=True)
    return any(abs(v) > options.size_factor * s.largest for v, s in sizes)


def find_oversized(
    scores: Sequence[Score], named: Sequence[str], options: DiscoveryOptions
) -> Score | None:
    """Returns the candidate that explains more than all named effects, at a size beyond belief.

    It is beyond chance as well. An effect that explains as much with another shape, at a size that
    is believed, was refitted and does not count.

    Args:
        scores: of all candidates on the nominal fit.
        named: names of the named effects.
        options: what is beyond chance and beyond belief.
    """
    own = max((s.gain for s in scores if s.candidate.effect.name in named), default=np.inf)
    refitted = {
        s.candidate.effect.name: s.gain for s in reversed(select_significant(scores, options))
    }
    found = [
        s for s in scores
        if correct_p_value(s, len(scores)) < options.significance
        and is_possible(s.candidate, s.size) and is_oversized(s.candidate, s.size, options)
        and options.equal_share * s.gain > own
        and s.gain > refitted.get(s.candidate.effect.name, 0.0)
    ]  # fmt: skip
    return max(found, key=lambda s: s.gain, default=None)


def correct_p_value(s: Score, count: int) -> float:
    """Returns the chance that one of `count` candidates scores as high by luck (Bonferroni)."""
    return min(1.0, s.p_value * count)


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
