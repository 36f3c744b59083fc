"""The candidates that are fitted: the few best scores that are beyond chance, and simpler ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.scoring.scores import WindowScore

# In a round, fitted to some of the windows; the best `max_refits`, and those near, to all.
MAX_CONTENDERS = 6
MAX_CURVES = 3  # of the data, fitted in a round: of speed, of position, and of one thing more
MAX_CHANCE = 0.05  # of a score, above which its effect is not refitted however few there are


def list_contenders(
    scores: Sequence[WindowScore], options: DiscoveryOptions, is_left: bool = False,
    are_curves: bool = False,
) -> list[WindowScore]:  # fmt: skip
    """Returns the few best scores beyond chance, with the best shape of each effect at each place.

    They are fitted to some windows, and the best of them to all: a score is linear, and what is
    right need not have the best one. Of curves several are, because what a cause depends on need
    not have the best score either.

    Args:
        scores: of all candidates, the best first.
        options: what is beyond chance, and how many are refitted.
        is_left: as `refit_level`.
        are_curves: whether curves of the data are asked, or laws.
    """
    some = [s for s in scores if s.candidate.effect.is_curve == are_curves]
    found = _best_few(some, refit_level(scores, options, is_left), options)
    return found[:MAX_CURVES] if are_curves else found


def list_limits(scores: Sequence[WindowScore], chosen: Sequence[WindowScore]) -> list[WindowScore]:
    """Returns the best score of each law that is there or is not, which was not chosen.

    A limit of a motor or of an input has no size that could be small: the score of a small share
    of it says little of the whole, about parameters that a fit without it has moved far.

    Args:
        scores: of all candidates, the best first.
        chosen: what is refitted anyway.
    """
    known = {s.candidate.key for s in chosen}
    each = {
        s.candidate.key: s
        for s in reversed(scores)
        if s.candidate.sizes and not s.candidate.free and s.candidate.key not in known
    }
    return [*reversed(each.values())]


def _best_few(
    listed: Sequence[WindowScore], level: float, options: DiscoveryOptions
) -> list[WindowScore]:
    each: dict[tuple[str, str], WindowScore] = {}
    for s in listed:
        if is_significant(s, level, options) and is_plausible(s, options):
            each.setdefault(s.candidate.key, s)
    out: list[WindowScore] = []
    best: dict[str, float] = {}
    for s in each.values():
        least = options.refit_share * max([t.gain for t in out], default=0.0)
        own = options.other_place_share * best.get(s.candidate.effect.name, 0.0)
        if s.gain > max(least, own):
            out.append(s)
            best.setdefault(s.candidate.effect.name, s.gain)
    return out[:MAX_CONTENDERS]


def is_significant(s: WindowScore, level: float, options: DiscoveryOptions) -> bool:
    """Returns whether a score is of less chance than a level, and large enough to matter."""
    return s.p_value < level and s.fall > options.min_fall


def beyond_chance(scores: Sequence[WindowScore], options: DiscoveryOptions) -> list[WindowScore]:
    """Returns the plausible scores that are beyond chance among all."""
    level = _level_among(scores, options)
    return [s for s in scores if is_significant(s, level, options) and is_plausible(s, options)]


def _level_among(scores: Sequence[WindowScore], options: DiscoveryOptions) -> float:
    """Returns the chance below which a score is beyond chance among all (Bonferroni)."""
    return options.significance / max(1, len(scores))


def refit_level(
    scores: Sequence[WindowScore], options: DiscoveryOptions, is_left: bool = False
) -> float:
    """Returns the chance below which the effect of a score is refitted.

    A refit is no proof, for unseen records decide, and a score about a model from which something
    is missing is less sure than what is refitted. So one false refit is expected where nothing is
    missing. Where a score is beyond chance among all, or the model errs by far more than its
    sensors, something is missing and only its name is asked: the right one may be a law whose
    score, by itself, is weak.

    Args:
        scores: of all candidates.
        options: what is beyond chance.
        is_left: whether much is left of the error of the model that was scored.
    """
    if not uses(options, "weak_scores"):
        return _level_among(scores, options)
    is_missing = is_left and uses(options, "scores_of_much_left")
    is_missing = is_missing or bool(beyond_chance(scores, options))
    return options.significance if is_missing else min(MAX_CHANCE, 1.0 / max(1, len(scores)))


def is_plausible(s: WindowScore, options: DiscoveryOptions) -> bool:
    """Returns whether the sizes of a score have signs that physics admits.

    Its magnitude is asked of the refit, whose bounds are those of physics. A score is linear, and
    about parameters that went wrong because the effect is missing: a soft stop whose curve takes
    away 79 % of an error seems to be five times as strong as it is.

    Args:
        s: the score.
        options: whether a score of too large a size is refitted.
    """
    sizes = s.candidate.effect.sizes
    most = np.inf if uses(options, "large_scores") else options.size_factor
    pairs = zip(s.size, sizes * (len(s.size) // len(sizes)), strict=True)
    return all(z.sign * v >= 0 and abs(v) <= most * z.largest for v, z in pairs)


def count_numbers(c: Candidate) -> int:
    """Returns how many numbers of an effect are estimated."""
    return len(c.free) + sum(shape.free for shape in c.effect.shapes)


def list_starts(score: WindowScore, scores: Sequence[WindowScore]) -> list[WindowScore]:
    """Returns another start of a law with free shapes: its best score with sizes of the other sign.

    Such a law often has two minima: a peak of friction at rest, and a lack of it at speed.

    Args:
        score: where a refit begins.
        scores: of all candidates, the best first.
    """
    if not any(shape.free for shape in score.candidate.effect.shapes):
        return []
    sign = np.sign(score.size[0])
    others = (
        s for s in scores
        if s.candidate.key == score.candidate.key and np.sign(s.size[0]) == -sign
    )  # fmt: skip
    return [s for s, _ in zip(others, range(1), strict=False)]
