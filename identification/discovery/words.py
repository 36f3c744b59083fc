"""Effects in words: where they act, how large they are, why one was not believed."""

from __future__ import annotations

from identification.discovery.result import Named, Tried
from identification.effect import Candidate
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


def against(tried: Tried) -> str:
    """What an effect that was not believed would do."""
    proof = tried.proof
    return (
        f"gain {tried.gain:.4g} on fitted samples; on unseen ones t = {proof.t:.1f}, and the mean"
        f" square {'falls' if proof.fall >= 0 else 'rises'} by {100 * abs(proof.fall):.3g} %"
    )
