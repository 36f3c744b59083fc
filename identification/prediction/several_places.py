"""An effect at several of its places at once, each with a size of its own.

Where one size for all places and one place alone both fall short (friction under load at two
joints of six), the places whose own scores are beyond chance are taken together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from identification.effects.effect import Candidate, Effect
from identification.prediction.scores import WindowScore


def at_several(effect: Effect, places: Sequence[str]) -> Effect:
    """The effect with one size for each of some places, acting on all of them.

    Args:
        effect: with these places among its own.
        places: in words, as in `Effect.places`.
    """
    sizes = tuple(
        replace(size, name=f"{size.name}{effect.places[where]}")
        for where in places
        for size in effect.sizes
    )
    return replace(effect, sizes=sizes, places={" and ".join(places): ""})


def list_several(significant: Sequence[WindowScore]) -> list[Candidate]:
    """Candidates at several places: of each effect the places where it is beyond chance.

    Args:
        significant: scores that are beyond chance and plausible, the best first.
    """
    best: dict[str, list[WindowScore]] = {}
    for s in significant:
        c = s.candidate
        own = best.setdefault(c.effect.name, [])
        if c.effect.places[c.where] and c.where not in [o.candidate.where for o in own]:
            own.append(s)
    out = []
    for scores in best.values():
        if len(scores) < 2:
            continue
        first = scores[0].candidate
        known = list(first.effect.places)
        places = sorted((s.candidate.where for s in scores), key=known.index)
        effect = at_several(first.effect, places)
        out.append(Candidate(effect, next(iter(effect.places)), first.shape, first.probe))
    return out
