"""Sensitivities of the outputs to every candidate effect, many candidates in one batch.

S_j = (ŷ(θ, η_j = h_j) - ŷ(θ, 0))/h_j          h_j: a probe, a size that a log would show
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from identification.effects.effect import Candidate, Effect
from identification.errors import DivergenceError, InputError
from identification.kalman.point import Point
from identification.model.predictor import Predictor

BATCH = 48  # simulations in one batch, which bounds the memory of their trajectories


@dataclass(frozen=True)
class Sensitivity:
    """Sensitivities of the outputs to one candidate.

    Attributes:
        candidate: the effect, its place and its shapes.
        S: shape (N, ny, m), per unit of each of its m sizes.
    """

    candidate: Candidate
    S: np.ndarray


def list_common(effects: Sequence[Effect]) -> tuple[Candidate, ...]:
    """Every effect with all its shapes, where it acts on all places at once.

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
    """Candidates that act on all places at once, at each of their single places, shapes kept."""
    return tuple(
        Candidate(c.effect, where, c.shape, c.probe)
        for c in common
        if not c.effect.places[c.where]
        for where, suffix in c.effect.places.items()
        if suffix
    )


def iterate_shapes(effect: Effect) -> Iterator[dict[str, float]]:
    """All combinations of the grids of an effect's shapes."""
    for values in product(*(shape.grid for shape in effect.shapes)):
        yield dict(zip((shape.name for shape in effect.shapes), values, strict=True))


def compute_sensitivities(point: Point, candidates: Sequence[Candidate]) -> tuple[Sensitivity, ...]:
    """Sensitivities of candidates at a point; one whose simulation diverges is left out.

    Args:
        point: the plant, at which the sizes of the candidates are zero.
        candidates: the effects, each at a place and with shapes.
    """
    predicted = point.log.outputs - point.e
    out: list[Sensitivity] = []
    for group in _groups(candidates):
        try:
            out += _batch(point, group, predicted)
        except (DivergenceError, InputError):
            for candidate in group:
                try:
                    out += _batch(point, [candidate], predicted)
                except (DivergenceError, InputError):
                    continue
    return tuple(out)


def _groups(candidates: Sequence[Candidate]) -> Iterator[list[Candidate]]:
    group: list[Candidate] = []
    for candidate in candidates:
        if sum(len(c.sizes) for c in (*group, candidate)) > BATCH and group:
            yield group
            group = []
        group.append(candidate)
    if group:
        yield group


def _batch(point: Point, group: list[Candidate], predicted: np.ndarray) -> list[Sensitivity]:
    own = point.values
    names = list(dict.fromkeys([*own, *(n for c in group for n in (*c.sizes, *c.fixed))]))
    parameters = point.predictor.plant.parameters
    nominal = [own.get(name, parameters[name].value) for name in names]
    rows, probes = [], []
    for c in group:
        for name, size in zip(c.sizes, c.effect.sizes, strict=True):
            row = dict(zip(names, nominal, strict=True))
            probe = (-size.probe if size.sign < 0 else size.probe) * c.probe
            rows.append([*{**row, **c.fixed, name: row[name] + probe}.values()])
            probes.append(probe)
    moved = Predictor(point.predictor.plant, point.log, tuple(names)).predict(np.array(rows))
    S = (moved - predicted) / np.array(probes)[:, None, None]
    ends = np.cumsum([len(c.sizes) for c in group])
    return [
        Sensitivity(c, np.moveaxis(S[end - len(c.sizes) : end], 0, -1))
        for c, end in zip(group, ends, strict=True)
    ]
