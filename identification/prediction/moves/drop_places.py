"""Places at which an effect that was named at several of them does nothing after all.

The places were chosen before later effects were there. Where one of these explains what a place
had explained, its size is no longer beyond its std; the name is then told without that place, if
unseen records are predicted as well.
"""

from __future__ import annotations

from dataclasses import replace

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.moves.drop_effects import as_good_without
from identification.prediction.scoring.screening import at_places, is_felt, places_of
from identification.prediction.task import Change, WindowSearch
from identification.runtime.progress import Progress


def drop_places(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model and its effects without places that are no longer needed."""
    model, options = state.model, state.task.options
    out = []
    for old in state.accepted:
        fewer, smaller = _fewer(model, old.candidate, options), None
        if fewer is not None:
            some = [fewer if c.key == old.candidate.key else c for c in model.candidates]
            smaller = as_good_without(model, some, state.task)
        if fewer is None or smaller is None:
            out.append(old)
            continue
        idle = [p for p in places_of(old.candidate.where) if p not in places_of(fewer.where)]
        progress(f"{old.candidate.effect.name}: no longer needed at {' and '.join(idle)}")
        model = smaller
        others = old.model.candidates[:-1]
        out.append(replace(old, model=replace(old.model, candidates=(*others, fewer))))
    return model, tuple(out), ()


def _fewer(model: WindowModel, c: Candidate, options: DiscoveryOptions) -> Candidate | None:
    """Returns the effect where it is felt; None where that is all of its places, or none."""
    places = places_of(c.where)
    if len(places) < 2 or c.effect.own or not set(c.sizes) <= set(model.std):
        return None
    m, each = len(c.sizes) // len(places), [*zip(c.sizes, c.effect.sizes, strict=True)]
    keep = [
        where
        for k, where in enumerate(places)
        if all(
            is_felt(model.values[name], model.std[name], size, options)
            for name, size in each[m * k : m * (k + 1)]
        )
    ]
    if not keep or keep == places:
        return None
    effect = at_places(c.effect, keep)
    return replace(c, effect=effect, where=next(iter(effect.places)))
