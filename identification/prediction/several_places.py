"""An effect at several of its places at once, each with a size of its own.

Where one size for all places and one place alone both fall short (friction under load at two
joints of six), all places are scored together. Places whose own size is of a sign that physics
does not admit, or not beyond its std, are then left out, and the others are scored again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect, Size
from identification.prediction.fit import WindowFit
from identification.prediction.scores import WindowScore, window_scores

AND = " and "  # between places, in words
MAX_SPREAD_EFFECTS = 4  # that are tried at several places; each takes a simulation for each place
MAX_LEAVING_ROUNDS = 3  # of leaving places out


def at_several(effect: Effect, places: Sequence[str]) -> Effect:
    """Returns the effect with one size for each of some places, acting on all of them.

    Args:
        effect: with these places among its own.
        places: in words, as in `Effect.places`.
    """
    sizes = tuple(
        replace(size, name=f"{size.name}{effect.places[where]}")
        for where in places
        for size in effect.sizes
    )
    return replace(effect, sizes=sizes, places={AND.join(places): ""})


def at_places(several: Effect, keep: Sequence[str]) -> Effect:
    """Returns an effect of `at_several` at some of its places.

    Args:
        several: with a size for each of its places.
        keep: those of its places that stay, in their order.
    """
    places = places_of(next(iter(several.places)))
    m = len(several.sizes) // len(places)
    sizes = tuple(
        size
        for k, where in enumerate(places)
        if where in keep
        for size in several.sizes[m * k : m * (k + 1)]
    )
    return replace(several, sizes=sizes, places={AND.join(keep): ""})


def places_of(where: str) -> list[str]:
    """Returns the places of an effect of `at_several` in words; of another effect its one place."""
    return where.split(AND)


def several_scores(
    fit: WindowFit, significant: Sequence[WindowScore], options: DiscoveryOptions
) -> list[WindowScore]:
    """Returns scores of the best effects at several places.

    Args:
        fit: the model without them.
        significant: scores that are beyond chance and plausible, the best first.
        options: what a size must be to count.
    """
    first: dict[str, Candidate] = {}
    for s in significant:
        if not s.candidate.effect.own and len(_single(s.candidate.effect)) > 1:
            first.setdefault(s.candidate.effect.name, s.candidate)
    out: list[WindowScore] = []
    for c in [*first.values()][:MAX_SPREAD_EFFECTS]:
        places = _single(c.effect)
        for _ in range(MAX_LEAVING_ROUNDS):
            found = window_scores(fit, [_at(c, places)])
            keep = felt_places(found[0], places, c.effect, options) if found else []
            if found and keep == places:
                out += found
            if keep == places or len(keep) < 2:
                break
            places = keep
    return out


def felt_places(
    score: WindowScore, places: Sequence[str], effect: Effect, options: DiscoveryOptions
) -> list[str]:
    """Returns places where all sizes are plausible in sign and magnitude, and beyond their std."""
    m = len(effect.sizes)
    out = []
    for k, where in enumerate(places):
        own = zip(
            score.size[m * k : m * (k + 1)], score.std[m * k : m * (k + 1)], effect.sizes,
            strict=True,
        )  # fmt: skip
        if all(is_felt(v, std, z, options) for v, std, z in own):
            out.append(where)
    return out


def is_felt(value: float, std: float, size: Size, options: DiscoveryOptions) -> bool:
    """Returns whether a size is beyond its std, and plausible in sign and magnitude."""
    return bool(
        size.sign * value >= 0
        and options.min_proof_t * std < abs(value) <= options.size_factor * size.largest
    )


def _single(effect: Effect) -> list[str]:
    return [where for where, suffix in effect.places.items() if suffix]


def _at(c: Candidate, places: Sequence[str]) -> Candidate:
    effect = at_several(c.effect, places)
    return Candidate(effect, next(iter(effect.places)), c.shape, c.probe)
