"""What the log could have shown: without it "nothing is missing" is not honest.

An effect of size η is found with probability 0.9 when η/std reaches t + z: t = 4.6 is what the
blocks demand at a chance of 0.01 over some 200 candidates, z = 1.3 the normal quantile of 0.9.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.result import Detectable
from identification.discovery.scoring.scores import Score

NONCENTRALITY = 35.0  # (4.6 + 1.3)²


def detectable(scores: Sequence[Score]) -> tuple[Detectable, ...]:
    """The smallest size of each effect that would have been found, by effect name.

    Of an effect's places and shapes the least favourable counts, but for one that acts everywhere:
    there the best scored shape does.

    Args:
        scores: of all candidates on the final model.
    """
    chosen: dict[str, Score] = {}
    for s in scores:
        name = s.candidate.effect.name
        chosen[name] = _worse(s, chosen.get(name, s))
    out = []
    for _, s in sorted(chosen.items()):
        for size, std in zip(s.candidate.effect.sizes, s.std, strict=True):
            smallest = float(np.sqrt(NONCENTRALITY) * std)
            testable = np.isfinite(smallest) and 0 < smallest <= size.farthest
            out.append(
                Detectable(s.candidate, size.name, smallest if testable else np.inf, size.unit)
            )
    return tuple(out)


def _worse(s: Score, before: Score) -> Score:
    """Of two places: the one that is everywhere, else the one that is harder to see."""
    if _everywhere(s) != _everywhere(before):
        return s if _everywhere(s) else before
    return before if _everywhere(s) or s.std.max() <= before.std.max() else s


def _everywhere(s: Score) -> bool:
    return not s.candidate.effect.places[s.candidate.where]
