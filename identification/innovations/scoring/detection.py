"""The smallest size of each effect that would have been found.

    δ ~ N(0, 1),   x = η/std(η̂),   x + δ = η̂/std(η̂)
    scored     |x + δ| > t_n                    a chance of α/n on each of two sides, n candidates
    proven     t > t_k        Student's t of the gain of η̂ over blocks of unseen samples, of
               noncentrality √r (x² - δ²)/(2|x + δ|); they weigh r of those that were fitted
    found      both, in 9 logs of 10

The gain of an effect on unseen samples is η̂ηh - η̂²h/2 + η̂√h ε with their information h, so that the
proof asks for more than the score unless the unseen samples are many. t_k is what the proof asks of
the likeliest of k refits.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq

from identification.chances import noncentral_student_above, student_above, student_level
from identification.discovery.effect_results import Detectable
from identification.discovery.options import DiscoveryOptions
from identification.innovations.scoring.scores import Score

FOUND = 0.9  # share of logs
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(80)  # of δ


@lru_cache(maxsize=128)
def smallest_ratio(
    candidates: int, freedom: float, unseen: float, options: DiscoveryOptions
) -> float:
    """Returns the x at which an effect is found in 9 logs of 10.

    Args:
        candidates: n.
        freedom: degrees of freedom of a score.
        unseen: r.
        options: which chances are asked for.
    """
    t_n = student_level(options.significance / (2 * candidates), freedom)
    blocks = options.proof_blocks - 1
    asked = student_above(options.min_proof_t, blocks) / options.max_refits
    t_k = student_level(asked, blocks)

    def short(x: float) -> float:
        z = np.abs(x + NODES)
        t = np.sqrt(unseen) * (x**2 - NODES**2) / (2 * z)
        found = np.where(z > t_n, noncentral_student_above(t_k, blocks, t), 0.0)
        return FOUND - float(WEIGHTS @ found) / float(WEIGHTS.sum())

    least, most = 0.01, 10 * (t_n + t_k / np.sqrt(unseen))
    if not np.isfinite(most) or short(most) > 0:  # no size is proven by so few samples
        return np.inf
    return least if short(least) <= 0 else float(brentq(short, least, most, xtol=1e-3))


def list_detectable(
    scores: Sequence[Score], unseen: float, options: DiscoveryOptions
) -> tuple[Detectable, ...]:
    """Returns the smallest size of each effect that would have been found, ordered by name.

    An effect that acts on all places at once is judged there, with the shape of its best score.
    Another one is judged at the place and shape where it is hardest to find.

    Args:
        scores: of all candidates on the final model, the best first.
        unseen: samples that decide over those that are fitted.
        options: the sizes that are believed, and the chances that are asked for.
    """
    chosen: dict[str, Score] = {}
    for s in scores:
        name = s.candidate.effect.name
        chosen[name] = _harder(s, chosen.get(name, s))
    out = []
    for _, s in sorted(chosen.items()):
        ratio = smallest_ratio(len(scores), s.freedom, unseen, options)
        for size, std in zip(s.candidate.effect.sizes, s.std, strict=True):
            smallest = float(ratio * std)
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
