"""Effects in words: what they are, where they act, how large they are, why one was rejected."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING

from identification.effects.neighbours import phrase_there
from identification.quantities import probability, quantity

if TYPE_CHECKING:  # a search is slow to import, and a page may tell of a model alone
    from identification.discovery.effect_results import (
        NamedEffect,
        Outside,
        Proof,
        RejectedEffect,
    )
    from identification.discovery.options import DiscoveryOptions
    from identification.discovery.result import Discovery
    from identification.discovery.scoring.scores import Score
    from identification.effects.effect import Candidate, Effect
    from identification.model.predictor import Plant

FEW = 0.01  # a chance above it is told as a share, and not as a power of ten


def describe_effect(candidate: Candidate) -> str:
    """Returns an effect and its place in words."""
    return f"{phrase(candidate.effect)}, {candidate.where}"


def describe_there(candidate: Candidate, plant: Plant) -> str:
    """Returns an effect and its place in words, in which a neighbouring joint has its name."""
    return f"{without_colon(phrase_there(candidate, plant))}, {candidate.where}"


def phrase(effect: Effect) -> str:
    """Returns an effect in words without a colon, because sentences have their own before it."""
    return without_colon(effect.phrase or effect.name.replace("_", " "))


def without_colon(said: str) -> str:
    """Returns words of a catalogue for a sentence that has a colon of its own."""
    return said.replace(": ", " – ", 1)


def describe_sizes(found: NamedEffect | RejectedEffect) -> str:
    """Returns sizes and shapes of a fitted effect with std, but no shape that no data tell."""
    effect = found.candidate.effect
    untold = {s.name for s in effect.shapes}
    about = {s.name: s.about for s in effect.sizes} | {s.name: s.about for s in effect.shapes}
    return ", ".join(
        f"{name} = {quantity(value, std, unit)}" + (f" ({about[name]})" if about.get(name) else "")
        for name, (value, std, unit) in found.parameters.items()
        if name not in untold or isfinite(std)
    )


def describe_rejected(found: Discovery) -> tuple[str, list[str]]:
    """Returns the effects that were refitted and not accepted: a title and a line each.

    Where an effect is named and no other one was refitted beside it, it is the candidate with the
    best score that is left.
    """
    beside = " beside what is named" if found.named else ""
    if found.rejected:
        each = [
            f"{describe_effect(r.candidate)}: {describe_sizes(r)}; {_describe_proof(r)}"
            for r in found.rejected
        ]
        return f"tried{beside}, and not believed", each
    if found.named and found.remaining:
        return f"next{beside}, and not refitted", [_describe_next(found.remaining, found.options)]
    return "", []


def _describe_next(scores: Sequence[Score], options: DiscoveryOptions) -> str:
    from identification.discovery.scoring.significance import correct_p_value

    best = max(scores, key=lambda s: s.gain)
    luck = correct_p_value(best, len(scores))
    why = f"chance {luck:.2g} that one of {len(scores)} does as well by luck"
    if luck < options.significance:
        why = "beyond chance, but at a size of the wrong sign, or larger than physics admits"
    return f"{describe_effect(best.candidate)}: gain {best.gain:z.3g}, {why}"


def describe_chance(proof: Proof) -> str:
    """Returns in words how far unseen samples are from chance."""
    chance = f"{proof.chance:.2g}" if proof.chance > FEW else probability(proof.chance)
    return f"t = {proof.t:z.1f}, chance {chance}"


def describe_gains(named: NamedEffect) -> str:
    """Returns in words what a named effect gains on fitted and on unseen samples."""
    gains = f"gain {named.gain:z.4g} on fitted samples, {named.proof.gain:z.4g} on unseen"
    return f"{gains} ({describe_chance(named.proof)})"


def _describe_proof(rejected: RejectedEffect) -> str:
    """Returns in words what a rejected effect would do on fitted and on unseen samples."""
    proof, outside = rejected.proof, rejected.outside
    instead = f"; instead of it, {describe_outside(outside)}" if outside is not None else ""
    turn = "falls" if proof.fall >= 0 else "rises"
    return (
        f"gain {rejected.gain:z.4g} on fitted samples; on unseen ones {describe_chance(proof)}, and"
        f" the mean square {turn} by {100 * abs(proof.fall):.3g} %"
        f"{instead}"
    )


def describe_outside(outside: Outside) -> str:
    """Returns in words a curve that no catalogue lists, and how likely it is."""
    link = "at" if outside.along == "time" else "of"
    return (
        f"some force that follows the {outside.along} {link} {outside.where}, by a law that is in"
        f" no catalogue ({100 * outside.confidence:.0f} %)"
    )
