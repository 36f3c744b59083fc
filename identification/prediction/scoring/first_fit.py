"""An effect fitted to some of the windows: where its fit to all of them begins.

It begins at the parent, moved by what the score gives or by the part of it that is best, with the
states that then are best; the parent's parameters make room for it.

The windows are spread evenly, so that shares of the error are those of all windows. Windows that
were chosen by their residual would show rare events, and shares that are not those of the record.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.candidates import iterate_shapes
from identification.discovery.nominal_model import SHAPE_STD, nonzero
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.estimation.priors import Priors
from identification.model.coordinates import coordinates
from identification.model.predictor import Plant
from identification.prediction.fits.model import WindowModel
from identification.prediction.scoring.columns import inside
from identification.prediction.scoring.joint_states import model_for
from identification.prediction.scoring.scores import WindowScore
from identification.windows.fit import solve
from identification.windows.problem import MIN_WINDOWS, Problem, with_unknowns
from identification.windows.shooting import Tangent

THIN = 3  # n: one window of so many
START_SHARES = (1.0, 0.3, 0.05, 0.01)  # of the size that a score gives, at which a fit begins
MAX_LINEARISATIONS = 12  # of a refit: an effect that takes more is not what is missing
REFIT_TOLERANCE = 1e-3  # relative fall of the criterion at which the refit of an effect ends


@dataclass(frozen=True)
class Begun:
    """An effect fitted to some of the windows."""

    cost: float  # V there
    windows: int  # how many of them
    candidate: Candidate  # the effect
    parent: WindowModel  # the model without it, its plant with the states that the effect needs
    fixed: Mapping[str, float]  # values that it holds fixed
    task: Problem  # all windows
    q: np.ndarray  # the estimate, shape (p,)


def begin(parent: WindowModel, scores: Sequence[WindowScore], is_loud: bool = True) -> Begun:
    """Returns an effect fitted to some of the windows, from the best of several starts.

    Args:
        parent: the model without it.
        scores: of the effect on the parent, one for each start: where shapes and sizes begin.
        is_loud: whether half of these windows are those that err most (`picks`).

    Raises:
        InputError: it cannot be simulated from any start, whatever the size.
    """
    starts = [s for one in scores for s in (_shaped(one) if one.candidate.effect.state else [one])]
    begun = [b for b in (_begun(parent, score, is_loud) for score in starts) if b is not None]
    if not begun:
        c = scores[0].candidate
        raise InputError(f"{c.effect.name}, {c.where} cannot be simulated at any size")
    return min(begun, key=lambda b: b.cost)


def _begun(parent: WindowModel, score: WindowScore, is_loud: bool) -> Begun | None:
    """Returns the fit of some windows; None where it cannot be simulated at any size."""
    c = score.candidate
    parent = model_for(parent, c)
    task, fixed = _task(parent, c)
    at = picks(parent.fit.tangents, is_loud=is_loud)
    few, begun = thinned(task, at), thinned_moves(parent.fit.moves, at)
    near = thinned_tangents(parent.fit.tangents, at)
    least = parent.fit.problem.cost_of(parent.fit.q, [t.r for t in near])
    tried = []
    for share in START_SHARES:
        q = _begin(task, parent, score, share)
        # the states have made up for what was missing
        settled = attempt(None, partial(few.settled, q, begun, near))
        if settled is None:
            continue
        moves, r = settled
        cost = few.cost_of(q, r)
        tried.append((cost, q, moves, r))
        if cost < least or not c.free:
            break
    if not tried:
        return None
    _, q, moves, r = min(tried, key=lambda t: t[0])
    found = solve(few, q, moves, tolerance=REFIT_TOLERANCE, known=r)
    windows = sum(len(rows) for rows in at)
    return Begun(found.cost, windows, c, parent, fixed, task, found.q)


def _task(parent: WindowModel, c: Candidate) -> tuple[Problem, dict[str, float]]:
    """Returns the problem with the parameters of one more effect, and the values held fixed."""
    plant, old = parent.plant, parent.fit.problem.unknowns
    sizes = _free(plant, c, [n for n in c.free if n not in old.local.names])
    shapes = _free(plant, c, [n for n in shapes_of(c) if n not in old.local.names])
    shared, own = old.shared.plus(shapes), old.own
    shared, own = (shared, own.plus(sizes)) if c.effect.own else (shared.plus(sizes), own)
    free = (*shared.names, *own.names)
    fixed = {n: v for n, v in (*c.fixed.items(), *c.whole.items()) if n not in free}
    return with_unknowns(parent.fit.problem, shared, own, fixed), fixed


def _shaped(score: WindowScore) -> list[WindowScore]:
    """Returns copies of the score, one for each grid value of its effect's free shapes.

    What joints with states do is far from linear in their sizes, so that a score tells the size
    and hardly the shapes.
    """
    c = score.candidate
    fixed = {s.name: c.shape[s.name] for s in c.effect.shapes if not s.free}
    return [
        replace(score, candidate=replace(c, shape=shape))
        for shape in iterate_shapes(c.effect)
        if all(shape[name] == value for name, value in fixed.items())
    ]


def _free(plant: Plant, c: Candidate, names: Sequence[str]) -> Priors:
    """Returns the prior of an effect's parameters: none of sizes, shapes near the grid's value."""
    if not names:
        return Priors()
    values = {**plant.parameters.values(), **c.fixed}
    start = [nonzero(plant.parameters[n], 0.0) if n in c.sizes else values[n] for n in names]
    first = inside(plant.parameters, names, np.array(start))
    space = coordinates(plant.parameters, names, first, linear=c.sizes)
    weight = np.array([0.0 if n in c.sizes else 1 / SHAPE_STD for n in names])
    return Priors(space, space.encode(first), weight)


def _begin(task: Problem, parent: WindowModel, score: WindowScore, share: float) -> np.ndarray:
    """Returns the start of a child's q: its parent's, moved by a share of what the score gives.

    The parent's parameters make room for the effect: what they imitated of it goes back.
    """
    c, unknowns = score.candidate, task.unknowns
    q = np.array(task.prior.mean)
    old = dict(zip(parent.fit.problem.names, parent.fit.q + share * score.along, strict=True))
    sizes = score.size.reshape(-1, len(c.sizes)) * np.ones((len(unknowns.records), 1))
    parameters = parent.plant.parameters
    for k in range(len(unknowns.records)):
        for name, value in zip(c.sizes, sizes[k], strict=True):
            if name in unknowns.local.names:
                at = unknowns.columns(k)[unknowns.local.names.index(name)]
                q[at] = nonzero(parameters[name], share * value) / task.prior.space.scale[at]
    for k, name in enumerate(task.names):
        q[k] = old.get(name, q[k])
    return np.asarray(task.prior.space.inside(q))


def shapes_of(c: Candidate) -> list[str]:
    """Returns the names of the plant's parameters of an effect's free shapes."""
    return [c.effect.parameter(s.name, c.where) for s in c.effect.shapes if s.free]


def picks(
    tangents: Sequence[Tangent], every: int = THIN, is_loud: bool = True
) -> tuple[np.ndarray, ...]:
    """Returns indices of one window of `every` a record, but of no fewer than `MIN_WINDOWS`.

    Half of them are those that err most, and the others are spread evenly. A stop, a limit or a
    play acts in few windows, and those that are spread evenly may have none of them.

    Args:
        tangents: of a fitted model, one a record.
        every: n.
        is_loud: whether the windows that err most are taken; otherwise all are spread evenly.
    """
    return tuple(_kept(np.sum(t.r**2, axis=1), every, is_loud) for t in tangents)


def _kept(squares: np.ndarray, every: int, is_loud: bool) -> np.ndarray:
    """Returns the indices of the windows that are kept, of those with these sums of squares."""
    count = len(squares)
    even = np.arange(0, count, max(1, min(every, count // MIN_WINDOWS)))
    if not is_loud or len(even) == count:
        return even
    loud = np.argsort(-squares, kind="stable")[: len(even) // 2]
    rest = np.setdiff1d(np.arange(count), loud)
    spread = np.linspace(0, len(rest) - 1, len(even) - len(loud)).round().astype(int)
    return np.sort(np.concatenate([loud, rest[spread]]))


def thinned(problem_: Problem, at: Sequence[np.ndarray]) -> Problem:
    """Returns the problem with some of the windows of each record, by their indices."""
    parts = zip(problem_.parts, at, strict=True)
    return replace(problem_, parts=tuple(part.rows(rows) for part, rows in parts))


def thinned_moves(moves: Sequence[np.ndarray], at: Sequence[np.ndarray]) -> tuple[np.ndarray, ...]:
    """Returns the moves of the states of these windows."""
    return tuple(d[rows] for d, rows in zip(moves, at, strict=True))


def thinned_tangents(tangents: Sequence[Tangent], at: Sequence[np.ndarray]) -> tuple[Tangent, ...]:
    """Returns the tangents of these windows."""
    return tuple(t.rows(rows) for t, rows in zip(tangents, at, strict=True))
