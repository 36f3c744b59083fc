"""An effect seen from the other side: records that confirm are fitted, and fitted ones confirm.

Which records are fitted is a choice, and physics does not depend on it. An effect that is proven
with one choice is contradicted where, with the roles of the records exchanged, it predicts worse on
average, or one of the records. It need not be proven once more: the records that confirm may be few
and tell little. A curve of the data is not asked: a record tells only the nodes that it reaches.

    |s - s'| > z √(σ² + σ'²)        s, s': a number of an effect in both roles; σ, σ': their std

Records that tell little of a size predict worse with it, too: a robot that hardly moved tells the
spring that hardens at the end of its way so badly that it spoils long ways. So records contradict
an effect only where a number of it differs between the roles by more than its std allow. These are
those of readings that err alike: by how blocks scatter, the contradiction itself would be scatter.

Where records that confirm are too few to prove the likeliest law, which misses chance alone, both
roles prove it together: the blocks of all records are then the sample, each predicted by a fit that
has not seen it (cross-fitting; Chernozhukov and others 2018).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.chances import normal_level
from identification.discovery.attempts import attempt, refuse_infinite
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.fits.crossing import at_their_best
from identification.prediction.fits.model import WindowModel, predict_fitted
from identification.prediction.judging.judging import doubt_of_size
from identification.prediction.judging.trial import (
    Contender,
    compared,
    contradicts_a_record,
    find_doubt,
    luck_of,
)
from identification.prediction.scoring.first_fit import (
    MAX_LINEARISATIONS,
    REFIT_TOLERANCE,
    shapes_of,
)
from identification.prediction.selection.selection import ranked
from identification.runtime.progress import Progress
from identification.windows.comparison import joined
from identification.windows.fit import solve
from identification.windows.problem import ROUGH_STEPS, Problem, no_moves, problem
from identification.windows.records import Record
from identification.windows.unseen import HORIZON


def without_contradicted(
    tried: Sequence[Contender], without: WindowModel, records: Sequence[Record], horizon: float,
    options: DiscoveryOptions, progress: Progress,
) -> tuple[tuple[Contender, ...], WindowModel | None]:  # fmt: skip
    """Returns contenders, contradicted ones unproven, and the first one with roles exchanged.

    Args:
        tried: contenders in their order, the proven ones first.
        without: the model without them, with the roles of the records exchanged.
        records: to fit and to confirm.
        horizon: [s].
        options: what matters.
        progress: is told what is contradicted.
    """
    rest, contradicted = list(tried), list[Contender]()
    unseen = [r for r in records if r.role == "fit"]
    while rest and rest[0].is_proven:
        if rest[0].candidate.effect.is_curve:  # a node is known only to records that reach it
            return (*rest, *contradicted), None
        with_it = exchanged(rest[0].model, records, horizon)
        if with_it is None:
            return (*rest, *contradicted), None
        parent = without
        if uses(options, "states_of_others"):
            parent, (with_it,) = at_their_best(without, [with_it], horizon, unseen)
        if not is_contradicted(parent, with_it, rest[0].model, options):
            return (*rest, *contradicted), with_it
        c = rest[0].candidate
        progress(f"{c.effect.name}, {c.where}: contradicted where the records exchange their roles")
        contradicted.append(replace(rest.pop(0), doubt="exchange"))
    return (*contradicted, *rest), None


def with_both_roles(
    tried: Sequence[Contender], without: WindowModel, records: Sequence[Record], horizon: float,
    options: DiscoveryOptions,
) -> tuple[Contender, ...]:  # fmt: skip
    """Returns contenders, one that misses chance alone proven if blocks of all records prove it.

    Args:
        tried: contenders in their order.
        without: the model without them, with the roles of the records exchanged.
        records: to fit and to confirm.
        horizon: [s].
        options: what is beyond chance, and what matters.
    """
    best = missing_chance_alone(tried, options)
    if best is None:
        return tuple(tried)
    with_it = exchanged(best.model, records, horizon)
    if with_it is None:
        return tuple(tried)
    if uses(options, "states_of_others"):
        unseen = [r for r in records if r.role == "fit"]
        without, (with_it,) = at_their_best(without, [with_it], horizon, unseen)
    both = joined(best.prediction, compared(without.unseen, with_it.unseen, options))
    tested = replace(best.prediction, t=both.t, chance=both.chance, rank_chance=both.rank_chance)
    asked = replace(best, prediction=tested, luck=luck_of(both, best.refits, options))
    doubt = find_doubt(both, best.refits, options)
    if doubt is None:
        doubt = doubt_of_size(best.model, options)
    return ranked([replace(asked, doubt=doubt), *(c for c in tried if c is not best)], options)


def missing_chance_alone(tried: Sequence[Contender], options: DiscoveryOptions) -> Contender | None:
    """Returns the law that would be taken if chance did not matter; None where one is taken anyway.

    Args:
        tried: contenders.
        options: what matters.
    """
    each = [replace(c, doubt=None) if c.doubt == "chance" else c for c in tried]
    if not each:
        return None
    first = ranked(each, options)[0]
    best = next(c for c, asked in zip(tried, each, strict=True) if asked is first)
    return best if best.doubt == "chance" and not best.candidate.effect.is_curve else None


def exchanged(model: WindowModel, records: Sequence[Record], horizon: float) -> WindowModel | None:
    """Returns the model fitted to the records that confirm; its unseen ones are those of its fit.

    Only the horizon is predicted: nothing else is asked of it.

    Args:
        model: where the search begins.
        records: to fit and to confirm.
        horizon: [s].

    Returns:
        The model; None where it cannot be simulated with what these records tell.
    """
    fitted, confirm = ([r for r in records if r.role == role] for role in ("confirm", "fit"))
    old = model.fit.problem.unknowns

    def evaluate() -> WindowModel:
        plant, values, scale = model.plant, model.values, model.scale
        task = problem(plant, fitted, old.shared, old.own, horizon, values, scale, ROUGH_STEPS)
        q = _begin(task, model)
        moves, r = task.settled(q, no_moves(task), is_thorough=True)
        found = solve(task, q, moves, tolerance=REFIT_TOLERANCE, most=MAX_LINEARISATIONS, known=r)
        fixed = {n: v for n, v in model.values.items() if n not in old.local.names}
        unseen = predict_fitted(model.plant, confirm, horizon, model.scale, found, fixed,
                                lengths=HORIZON)  # fmt: skip
        refuse_infinite(found.cost, *unseen.at_horizon)
        return WindowModel(model.candidates, found, unseen, model.scale)

    return attempt(None, evaluate)


def is_contradicted(
    without: WindowModel, with_it: WindowModel, model: WindowModel, options: DiscoveryOptions
) -> bool:
    """Returns whether records contradict effects: prediction is worse, and their numbers differ.

    Worse is a prediction on average, or of one record by enough to matter.

    Args:
        without: the model without them, with the roles of the records exchanged.
        with_it: the model with them, likewise.
        model: with them, and with the roles as they are.
        options: what matters, and what is beyond chance.
    """
    found = compared(without.unseen, with_it.unseen, options)
    if found.gain > 0 and not contradicts_a_record(found, options):
        return False
    known = {c.key for c in without.candidates}
    new = [c for c in with_it.candidates if c.key not in known]
    is_asked = uses(options, "numbers_of_roles")
    return not is_asked or _differ(model, with_it, new, options.significance)


def _differ(
    model: WindowModel, other: WindowModel, effects: Sequence[Candidate], level: float
) -> bool:
    """Returns whether a number of effects differs between two fits beyond chance.

    One that ends on a bound, or that a fit does not feel, differs from any.

    Args:
        model: a fit with the effects.
        other: one to other data.
        effects: that both have.
        level: of chance, for all numbers together.
    """
    each = [_std_of_readings(m) for m in (model, other)]
    at_bound = {*model.at_bound, *other.at_bound}
    shared = {*each[0], *each[1]}
    names = [n for c in effects for n in (*c.free, *shapes_of(c)) if n in shared]
    if not names or at_bound & {*names} or any(n not in std for n in names for std in each):
        return True
    z = normal_level(level / 2 / len(names))
    apart = [abs(model.fit.values[n] - other.fit.values[n]) for n in names]
    std = [float(np.hypot(each[0][n], each[1][n])) for n in names]
    return any(d > z * s for d, s in zip(apart, std, strict=True))


def _std_of_readings(model: WindowModel) -> dict[str, float]:
    """Returns the std of each free value that is felt, if all readings err alike, in its unit."""
    fit = model.fit
    scale = 1 / np.diag(fit.problem.parts[0].whitener)
    power = np.mean(np.concatenate([np.ravel((e / scale) ** 2) for e in fit.errors]))
    inverse = np.linalg.pinv(fit.curvature, hermitian=True)
    known = power * fit.information + np.diag(fit.problem.prior.weight**2)
    free = np.diag(inverse @ known @ inverse)
    std = np.sqrt(free) * np.abs(fit.problem.prior.space.slope(fit.q))
    each = zip(fit.problem.names, std, fit.std, strict=True)
    return {n: float(s) for n, s, by_blocks in each if np.isfinite(by_blocks)}


def _begin(task: Problem, model: WindowModel) -> np.ndarray:
    """Returns the start of the search, (p,): the model's values and those that halves tell."""
    unknowns = task.unknowns
    own = unknowns.own
    q = [model.fit.q[: len(unknowns.shared.names)]]
    for name in unknowns.records:
        told = model.unseen.own.get(name, {})
        values = own.space.decode(own.mean)
        each = [told.get(n, (v, 0.0))[0] for n, v in zip(own.names, values, strict=True)]
        q.append(own.space.encode(np.array(each)) if each else np.zeros(0))
    return np.asarray(task.prior.space.inside(np.concatenate(q)))
