"""Effects in words: where they act, how large they are, why one was not believed."""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.result import Discovery, Named, Tried
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.significance import ALPHA, chance
from identification.effects.effect import Candidate
from identification.quantities import quantity


def phrase(candidate: Candidate) -> str:
    """An effect and its place in words."""
    said = candidate.effect.phrase or candidate.effect.name.replace("_", " ")
    return f"{said}, {candidate.where}"


def sizes(found: Named | Tried) -> str:
    """Sizes and shapes of a fitted effect, each with its std."""
    effect = found.candidate.effect
    about = {s.name: s.about for s in effect.sizes} | {s.name: s.about for s in effect.shapes}
    return ", ".join(
        f"{name} = {quantity(value, std, unit)}" + (f" ({about[name]})" if about.get(name) else "")
        for name, (value, std, unit) in found.parameters.items()
    )


def not_believed(found: Discovery) -> tuple[str, list[str]]:
    """What was tried and not believed, or what would have been the next: a title and its lines."""
    beside = " beside what is named" if found.named else ""
    if found.rejected:
        each = [f"{phrase(t.candidate)}: {sizes(t)}; {against(t)}" for t in found.rejected]
        return f"tried{beside}, and not believed", each
    if found.named and found.remaining:
        return f"next{beside}, and not refitted", [_not_refitted(found.remaining)]
    return "", []


def _not_refitted(scores: Sequence[Score]) -> str:
    best = max(scores, key=lambda s: s.gain)
    luck = chance(best, scores)
    why = f"chance {luck:.2g} that one of {len(scores)} does as well by luck"
    if luck < ALPHA:
        why = "beyond chance, but at a size of the wrong sign, or larger than physics admits"
    return f"{phrase(best.candidate)}: gain {best.gain:.3g}, {why}"


def beyond(score: Score) -> str:
    """A candidate that explains more than what is named, at a size that is not believed."""
    each = zip(score.candidate.effect.sizes, score.size, strict=True)
    said = ", ".join(
        f"{s.name} = {quantity(value, unit=s.unit)} where {quantity(s.farthest, unit=s.unit)} is"
        " thought to be the most"
        for s, value in each
        if abs(value) > s.farthest
    )
    return (
        f"{phrase(score.candidate)}, which would explain more than what is named (gain"
        f" {score.gain:.4g}), but only at {said}"
    )


def against(tried: Tried) -> str:
    """What an effect that was not believed would do."""
    proof = tried.proof
    return (
        f"gain {tried.gain:.4g} on fitted samples; on unseen ones t = {proof.t:.1f}, and the mean"
        f" square {'falls' if proof.fall >= 0 else 'rises'} by {100 * abs(proof.fall):.3g} %"
    )
