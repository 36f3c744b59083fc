"""The smallest effects that a log would have shown, without which "nothing missing" says little.

An effect of size η is found with probability 0.9 when (η/std)² is `DETECTION_NONCENTRALITY`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.effect_results import Detectable
from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.scores import Score

# (4.6 + 1.3)² of a noncentral F: t = 4.6 is what the blocks demand at a chance of 0.01 over 200
# candidates, and 1.3 is the normal quantile of 0.9.
DETECTION_NONCENTRALITY = 35.0


def list_detectable(scores: Sequence[Score], options: DiscoveryOptions) -> tuple[Detectable, ...]:
    """Returns the smallest size of each effect that would have been found, ordered by name.

    An effect that acts on all places at once is judged there, with the shape of its best score.
    Another one is judged at the place and shape where it is hardest to find.

    Args:
        scores: of all candidates on the final model, the best first.
        options: the sizes that are believed.
    """
    chosen: dict[str, Score] = {}
    for s in scores:
        name = s.candidate.effect.name
        chosen[name] = _harder(s, chosen.get(name, s))
    out = []
    for _, s in sorted(chosen.items()):
        for size, std in zip(s.candidate.effect.sizes, s.std, strict=True):
            smallest = float(np.sqrt(DETECTION_NONCENTRALITY) * std)
            largest = options.size_factor * size.largest
            is_testable = np.isfinite(smallest) and 0 < smallest <= largest
            out.append(
                Detectable(s.candidate, size.name, smallest if is_testable else np.inf, size.unit)
            )
    return tuple(out)


def _harder(s: Score, before: Score) -> Score:
    """Returns the one of two scores that is on all places, else the one that is harder to find."""
    if _is_everywhere(s) != _is_everywhere(before):
        return s if _is_everywhere(s) else before
    return before if _is_everywhere(s) or s.std.max() <= before.std.max() else s


def _is_everywhere(s: Score) -> bool:
    return not s.candidate.effect.places[s.candidate.where]
