"""Sensitivities of the outputs to every candidate effect, many candidates in one batch.

S_j = (ŷ(θ, η_j = h_j) - ŷ(θ, 0))/h_j          h_j: a probe, a size that a log would show
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np

from identification.discovery.attempts import attempt, refuse_infinite
from identification.effects.effect import Candidate
from identification.kalman.linear import Linearisation, linearise_records
from identification.kalman.point import EQUATION_STEP_SHARE, Point, do_equations_hold
from identification.kalman.sensitivity_equations import ALWAYS, Courses, solve_sensitivities
from identification.kalman.trajectory import FINE_POINTS
from identification.model.predictor import Predictor
from identification.runtime.heap import release
from identification.runtime.pool import each_part
from identification.runtime.progress import counted

LONG_AGO = 1e6  # before a record [s], later than any ramp lasts
MAX_BATCH_COLUMNS = 64  # that are computed at once, which bounds the memory of their trajectories


@dataclass(frozen=True)
class Sensitivity:
    """Sensitivities of the outputs to one candidate."""

    candidate: Candidate  # the effect, its place and its shapes
    S: np.ndarray  # shape (N, ny, m), per unit of each of its m sizes


def compute_sensitivities(point: Point, candidates: Sequence[Candidate]) -> tuple[Sensitivity, ...]:
    """Computes sensitivities of candidates at a point; one whose simulation diverges is left out.

    They come from the sensitivity equations, where these hold at the point, and else from a
    simulation with each.

    Args:
        point: the plant, at which the sizes of the candidates are zero.
        candidates: the effects, each at a place and with shapes.
    """
    release()
    found: dict[int, Sensitivity] = {}
    # A model that is linearised at its samples alone need not be so between them.
    records = attempt(None, partial(_fine_records, point)) or ()
    if records:
        groups = [*_groups([*enumerate(candidates)])]
        each = each_part(partial(_alone, partial(_solve, point, records)), groups)
        for solved in counted(each, "groups of candidates", len(groups)):
            found |= solved
    predicted = point.log.outputs - point.e
    rest = [*_groups([(i, c) for i, c in enumerate(candidates) if i not in found])]
    for group in counted(rest, "groups of other candidates", len(rest)):
        found |= _alone(partial(_simulate, point, predicted), group)
    return tuple(found[i] for i in sorted(found))


def compute_beside(point: Point, candidates: Sequence[Candidate]) -> tuple[Sensitivity, ...]:
    """Computes sensitivities to an effect of other shapes, along the trajectory with its own one.

    A plant has an effect in one shape only. So the response to another shape with a probe as its
    size is compared with the response to no effect, both by the sensitivity equations.

    Args:
        point: the plant with the effect.
        candidates: the same effect at the same place, with other shapes.

    Returns:
        Those that the equations describe; none where they do not hold at the point.

    Raises:
        DivergenceError: accelerations along the trajectory are not finite.
    """
    records = _fine_records(point) if candidates else ()
    if not records:
        return ()
    sizes, own = candidates[0].effect.sizes, point.values
    probes = np.array([-size.probe if size.sign < 0 else size.probe for size in sizes])
    bare = [{**own, **c.fixed, **dict.fromkeys(c.sizes, 0.0)} for c in candidates]
    rows = [
        [*row.values()]
        for c, none in zip(candidates, bare, strict=True)
        for row in (none, *({**none, n: h} for n, h in zip(c.sizes, probes, strict=True)))
    ]
    predictor = Predictor(point.predictor.plant, point.log, tuple(bare[0]))
    values = np.array([own[name] for name in bare[0]])
    S = solve_sensitivities(predictor, records, values, np.array(rows), np.ones(len(rows)))
    each = np.split(S, len(candidates), axis=2)
    found = [(x[..., 1:] - x[..., :1]) / probes for x in each]
    return tuple(
        Sensitivity(c, s) for c, s in zip(candidates, found, strict=True) if np.isfinite(s).all()
    )


@lru_cache(maxsize=1)
def _fine_records(point: Point) -> tuple[Linearisation, ...]:
    """Returns the linearisation at a point, as fine as candidates need; none where it fails."""
    records = linearise_records(point.predictor, point.space.decode(point.q), points=FINE_POINTS)
    holds = do_equations_hold(point.predictor, point.space, point.q, records, point.J)
    return records if holds else ()


def forget_records() -> None:
    """Frees the linearisation of the last point, which takes as much memory as a model."""
    _fine_records.cache_clear()


def _alone(
    compute: Callable[[list[Candidate]], Sequence[Sensitivity | None]],
    group: list[tuple[int, Candidate]],
) -> dict[int, Sensitivity]:
    """Returns what is computed of a group, or of each candidate alone if one of them diverges."""
    found = attempt(None, partial(compute, [c for _, c in group]))
    if found is not None:
        return {i: s for (i, _), s in zip(group, found, strict=True) if s is not None}
    if len(group) == 1:
        return {}
    return {i: s for one in group for i, s in _alone(compute, [one]).items()}


def _groups(candidates: Sequence[tuple[int, Candidate]]) -> Iterator[list[tuple[int, Candidate]]]:
    group: list[tuple[int, Candidate]] = []
    columns = 0
    for i, candidate in candidates:
        columns += len(candidate.effect.sizes)
        if columns > MAX_BATCH_COLUMNS and group:
            yield group
            group, columns = [], len(candidate.effect.sizes)
        group.append((i, candidate))
    if group:
        yield group


def _solve(
    point: Point, records: tuple[Linearisation, ...], group: list[Candidate]
) -> list[Sensitivity | None]:
    """Returns sensitivities by the equations; None for a candidate that they do not describe."""
    families: dict[tuple[Any, ...], list[int]] = {}
    for i, candidate in enumerate(group):
        alone = candidate.effect.onset is None
        families.setdefault((i,) if alone else _family(candidate), []).append(i)
    one_each = [_long_begun(group[members[0]]) for members in families.values()]
    courses = [_courses([group[i] for i in members]) for members in families.values()]
    predictor, values, rows, probes = _probe(point, one_each, EQUATION_STEP_SHARE)
    of_rows = [of for c, of in zip(one_each, courses, strict=True) for _ in c.sizes]
    S = solve_sensitivities(predictor, records, values, rows, probes, of_rows)
    out: list[Sensitivity | None] = [None] * len(group)
    end = 0
    for c, members in zip(one_each, families.values(), strict=True):
        first, end = end, end + len(c.sizes) * len(members)
        own = S[..., first:end].reshape(*S.shape[:2], len(c.sizes), len(members))
        for k, i in enumerate(members):
            if np.isfinite(own[..., k]).all():
                out[i] = Sensitivity(group[i], own[..., k].copy())
    return out


def _family(c: Candidate) -> tuple[Any, ...]:
    """Returns a key that candidates share if they differ only in the time of their onset."""
    begins = c.effect.onset.shape if c.effect.onset else ""
    return (*c.key, c.probe, *((n, v) for n, v in c.shape.items() if n != begins))


def _long_begun(c: Candidate) -> Candidate:
    """Returns the candidate as one that began long before the record."""
    if c.effect.onset is None:
        return c
    return replace(c, shape={**c.shape, c.effect.onset.shape: -LONG_AGO})


def _courses(family: list[Candidate]) -> Courses:
    """Returns the courses in time of candidates that differ only in when they begin."""
    onset = family[0].effect.onset
    if onset is None:
        return ALWAYS
    return [partial(onset.course, begins=c.shape[onset.shape]) for c in family]


def _simulate(point: Point, predicted: np.ndarray, group: list[Candidate]) -> list[Sensitivity]:
    """Returns sensitivities by simulations with each candidate."""
    predictor, _, rows, probes = _probe(point, group, 1.0)
    S = (predictor.predict(rows) - predicted) / probes[:, None, None]
    refuse_infinite(S)
    return _each(group, S)


def _probe(
    point: Point, group: list[Candidate], shorter: float
) -> tuple[Predictor, np.ndarray, np.ndarray, np.ndarray]:
    """Returns a predictor, its values, and the values with each size of each candidate as a probe.

    Args:
        point: the plant.
        group: the candidates.
        shorter: factor of the probes of effects whose outputs are linear in their sizes.

    Returns:
        The predictor, shape (p,), shape (m, p), and the probes, shape (m,).
    """
    own = point.values
    names = list(dict.fromkeys([*own, *(n for c in group for n in (*c.sizes, *c.fixed))]))
    parameters = point.predictor.plant.parameters
    nominal = [own.get(name, parameters[name].value) for name in names]
    rows, probes = [], []
    for c in group:
        factor = c.probe * (shorter if len(c.effect.probes) == 1 else 1.0)
        for name, size in zip(c.sizes, c.effect.sizes, strict=True):
            row = dict(zip(names, nominal, strict=True))
            probe = (-size.probe if size.sign < 0 else size.probe) * factor
            rows.append([*{**row, **c.fixed, name: row[name] + probe}.values()])
            probes.append(probe)
    predictor = Predictor(point.predictor.plant, point.log, tuple(names))
    return predictor, np.array(nominal), np.array(rows), np.array(probes)


def _each(group: list[Candidate], S: np.ndarray) -> list[Sensitivity]:
    """Returns the sensitivities of each candidate, from those of all sizes, shape (m, N, ny)."""
    ends = np.cumsum([len(c.sizes) for c in group])
    return [
        Sensitivity(c, np.moveaxis(S[end - len(c.sizes) : end], 0, -1))
        for c, end in zip(group, ends, strict=True)
    ]
