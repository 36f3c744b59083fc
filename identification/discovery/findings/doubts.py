"""Effects that may be missing and are not named: not proven, or of a size beyond belief."""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.effect_results import RejectedEffect
from identification.discovery.findings.evidence import DoubtfulEffect, OversizedEffect
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.fitted_model import is_far_likelier, is_relevant
from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.significance import find_oversized


def find_doubtful_effect(
    rejected: Sequence[RejectedEffect], samples: int, options: DiscoveryOptions
) -> tuple[Finding, ...]:
    """Returns the best effect that fitted samples want and that would matter, but is not proven.

    Of an effect that makes the unseen samples less likely there is no doubt: it is not there. Only
    where the fitted samples want it far more than BIC asks does a doubt remain.

    Args:
        rejected: effects that were refitted and not accepted, the best first.
        samples: that were fitted.
        options: which effects would matter.
    """
    wanted = [
        r for r in rejected
        if is_relevant(r.proof, options)
        and (r.bic_gain > 0 < r.proof.gain or is_far_likelier(r.candidate, r.bic_gain, samples))
    ]  # fmt: skip
    return tuple(Finding(FindingKind.DOUBTFUL_EFFECT, DoubtfulEffect(r)) for r in wanted[:1])


def find_oversized_effect(
    scores: Sequence[Score], named: Sequence[str], options: DiscoveryOptions
) -> tuple[Finding, ...]:
    """Returns the candidate that explains more than all named effects, at a size beyond belief.

    Args:
        scores: of all candidates on the nominal fit.
        named: names of the named effects.
        options: which sizes are believed.
    """
    score = find_oversized(scores, named, options)
    if score is None:
        return ()
    limits = {
        s.name: options.size_factor * s.largest
        for s, value in zip(score.candidate.effect.sizes, score.size, strict=True)
        if abs(value) > options.size_factor * s.largest
    }
    return (Finding(FindingKind.OVERSIZED_EFFECT, OversizedEffect(score, limits)),)
