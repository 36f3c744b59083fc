"""Selection of the scores worth a refit: beyond chance, with a size that physics admits.

max(p_j, p_j by blocks) n < significance        n candidates (Bonferroni)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate


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
    return min(1.0, max(s.p_value, s.block_p_value) * count)
