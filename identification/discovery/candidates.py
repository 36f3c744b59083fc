"""The candidates of a search: effects at places, with each shape of their grids."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from identification.effects.effect import Candidate, Effect


def list_common(effects: Sequence[Effect]) -> tuple[Candidate, ...]:
    """Returns candidates of every effect with all its shapes, on all places at once.

    An effect that has no such place is listed at each of its single places.
    """
    out = []
    for effect in effects:
        everywhere = [where for where, suffix in effect.places.items() if not suffix]
        for where in everywhere or effect.places:
            out += [
                Candidate(effect, where, shape, probe)
                for shape in iterate_shapes(effect)
                for probe in effect.probes
            ]
    return tuple(out)


def list_single(common: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Returns candidates that act on all places at once, at each single place, shapes kept."""
    return tuple(
        Candidate(c.effect, where, c.shape, c.probe)
        for c in common
        if not c.effect.places[c.where]
        for where, suffix in c.effect.places.items()
        if suffix
    )


def list_between(candidate: Candidate) -> tuple[Candidate, ...]:
    """Returns a candidate with values of its stepped shapes between the neighbours in the grids."""
    out: tuple[Candidate, ...] = ()
    for shape in candidate.effect.shapes:
        if not shape.step:
            continue
        grid, here = sorted(shape.grid), candidate.shape[shape.name]
        first = max((v for v in grid if v < here), default=here)
        last = min((v for v in grid if v > here), default=here)
        values = np.arange(first + shape.step, last, shape.step)
        out += tuple(replace(candidate, shape={**candidate.shape, shape.name: v}) for v in values)
    return out


def iterate_shapes(effect: Effect) -> Iterator[dict[str, float]]:
    """Yields all combinations of the grids of an effect's shapes."""
    for values in product(*(shape.grid for shape in effect.shapes)):
        yield dict(zip((shape.name for shape in effect.shapes), values, strict=True))
