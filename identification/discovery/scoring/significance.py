"""Which scores are worth a refit: beyond chance, with a size that physics admits.

max(p_j, p_j by blocks) n < ALPHA        n candidates (Bonferroni)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate

ALPHA = 0.01  # family-wise chance of a name where nothing is missing, before the proof
LIKE = 0.8  # share of a score that makes another one as good


def significant(scores: Sequence[Score]) -> list[Score]:
    """Scores beyond chance with plausible sizes, the best shape of each effect and place."""
    each: dict[tuple[str, str], Score] = {}
    for s in sorted(scores, key=_as_a_whole, reverse=True):
        likely = chance(s, scores) < ALPHA
        if likely and plausible(s.candidate, s.size) and s.gain > 0:
            each.setdefault((s.candidate.effect.name, s.candidate.where), s)
    return sorted(each.values(), key=lambda s: -s.gain)


def _as_a_whole(s: Score) -> float:
    """Gain of a score, less where its size is not the one that the effect has when it is there."""
    fixed = [size.present for size in s.candidate.effect.sizes]
    if fixed[0] is None or s.size[0] <= 0:
        return s.gain
    return s.gain * float(np.exp(-abs(np.log(s.size[0] / fixed[0]))))


def plausible(candidate: Candidate, size: np.ndarray) -> bool:
    """Whether sizes have the right sign and are not beyond what physics admits."""
    return possible(candidate, size) and not larger(candidate, size)


def possible(candidate: Candidate, size: np.ndarray) -> bool:
    """Whether sizes have a sign that physics admits."""
    return all(s.sign * v >= 0 for v, s in zip(size, candidate.effect.sizes, strict=True))


def larger(candidate: Candidate, size: np.ndarray) -> bool:
    """Whether a size is beyond what is thought to be plausible."""
    return any(abs(v) > s.farthest for v, s in zip(size, candidate.effect.sizes, strict=True))


def find_oversized(scores: Sequence[Score], named: Sequence[str]) -> Score | None:
    """What explains more than all that is named, beyond chance, but at a size beyond belief.

    An effect that explains as much with another shape, at a size that is believed, had its trial.

    Args:
        scores: of all candidates on the nominal fit.
        named: effects that are named.
    """
    own = max((s.gain for s in scores if s.candidate.effect.name in named), default=np.inf)
    heard = {s.candidate.effect.name: s.gain for s in reversed(significant(scores))}
    found = [
        s for s in scores
        if chance(s, scores) < ALPHA
        and possible(s.candidate, s.size) and larger(s.candidate, s.size)
        and LIKE * s.gain > own and s.gain > heard.get(s.candidate.effect.name, 0.0)
    ]  # fmt: skip
    return max(found, key=lambda s: s.gain, default=None)


def chance(s: Score, scores: Sequence[Score]) -> float:
    """That one of some candidates does as well by luck."""
    return min(1.0, max(s.p_value, s.block_p_value) * len(scores))
