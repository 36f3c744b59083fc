"""Laws with fewer numbers than the best effect, which may be what it imitates.

A curve, a peak with a power or a friction with two loads draws what a plainer law does, and has the
better score where the fit without any effect has moved other values to make up for what is missing.
So the plainer laws are scored and refitted from the values at which the best effect ended.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import at_values_of
from identification.prediction.judging.trial import Contender, find_doubt
from identification.prediction.scoring.contenders import (
    count_numbers,
    is_plausible,
    is_significant,
    refit_level,
)
from identification.prediction.scoring.scores import WindowScore, window_scores

MAX_SIMPLER_LAWS = 2  # with fewer numbers, refitted beside the best one


def simpler_laws(
    parent: WindowModel, best: Contender, scores: Sequence[WindowScore],
    options: DiscoveryOptions, is_left: bool,
) -> tuple[WindowModel, list[WindowScore]]:  # fmt: skip
    """Returns laws with fewer numbers that act as the best one does, and the model to begin at.

    They are scored and begin where the best one ended: about the fit without any effect, whose
    values make up for what is missing, the right law may have a weak score, and its refit may end
    elsewhere.

    Args:
        parent: the model without it.
        best: the best effect.
        scores: of all candidates, on the parent.
        options: what is beyond chance.
        is_left: as `refit_level`.
    """
    there = attempt(None, partial(at_values_of, parent, best.model)) or parent
    simpler = window_scores(there.fit, simpler_than(best.candidate, scores))
    return there, list_simpler(simpler, scores, options, is_left)


def is_dear(c: Contender, refits: int, options: DiscoveryOptions) -> bool:
    """Returns whether only the price of its numbers is against an effect: a curve has many."""
    return c.doubt == "numbers" and find_doubt(c.prediction, refits, options) is None


def likelier(models: Sequence[WindowModel]) -> list[WindowModel]:
    """Returns models without those that a fit of the same effect from elsewhere explains better."""
    each: dict[tuple[str, str], WindowModel] = {}
    for m in sorted(models, key=lambda m: m.fitted_power):
        each.setdefault(m.candidates[-1].key, m)
    return [m for m in models if each[m.candidates[-1].key] is m]


def simpler_than(winner: Candidate, scores: Sequence[WindowScore]) -> list[Candidate]:
    """Returns laws with fewer numbers that act as the winner does, at its place.

    Args:
        winner: which promised most.
        scores: of all candidates.
    """
    numbers, way = count_numbers(winner), _way_of(winner)
    each = (s.candidate for s in scores if s.candidate.where == winner.where)
    return [c for c in each if _way_of(c) == way and count_numbers(c) < numbers]


def _way_of(c: Candidate) -> frozenset[str]:
    """Returns how an effect acts; a friction is a force, whether it is counted with the motion."""
    return frozenset("force" if hook == "friction" else hook for hook in c.effect.hooks)


def list_simpler(
    simpler: Sequence[WindowScore], scores: Sequence[WindowScore], options: DiscoveryOptions,
    is_left: bool = False,
) -> list[WindowScore]:  # fmt: skip
    """Returns the best scores of laws that are simpler than the winner.

    Args:
        simpler: scores of the laws, the best first.
        scores: of all candidates.
        options: what is beyond chance.
        is_left: as `refit_level`.
    """
    each: dict[str, WindowScore] = {}
    level = refit_level(scores, options, is_left)
    for s in simpler:
        if is_significant(s, level, options) and is_plausible(s, options):
            each.setdefault(s.candidate.effect.name, s)
    return [*each.values()][:MAX_SIMPLER_LAWS]
