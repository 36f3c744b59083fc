"""Parts of a robot that deviate from the others by more than parts do: these are effects.

    |x_j - mean of n others| > 3 s_g √(1 + 1/n)     x_j: the deviation of a part in the nominal fit
                                                    s_g: the usual std

The nominal fit follows such a part, because only its prior speaks against it: nothing is left for a
candidate to explain. So, once no candidate is left to add, the deviation becomes an effect of that
part, and from here on every part is kept within three std of the others. In the model without the
effect their common value stays where the n other parts have it, but for the little by which the
root is above one: else it moves towards the part that is off, and all others are off the other way.

A part is no effect where holding it within bounds costs less than BIC asks of a parameter. To first
order, σ_j being the std of x_j with its prior, that is

    (|x_j - mean| - bound)² (1/σ_j² - 1/s_g²) < ln n
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from identification.discovery.effect_results import Proof
from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.innovations.fitted_model import (
    NEEDED_BIC_RATIO,
    ROUGH_FIT_STEPS,
    AcceptedEffect,
    FittedModel,
    is_confirmed,
    try_fit,
)
from identification.innovations.proof import prove
from identification.innovations.task import DiscoveryTask
from identification.runtime.progress import Progress


def find_deviants(task: DiscoveryTask, model: FittedModel) -> tuple[Candidate, ...]:
    """Returns the effects of parts that have to deviate by more than parts do, the farthest first.

    Args:
        task: with the nominal model, which knows the effect of each deviation.
        model: a fit in which parts are free.
    """
    nominal, values = task.nominal_model, model.refit.point.values
    has = {candidate.key for candidate in model.candidates}
    groups = nominal.grouped
    known = dict(zip(model.refit.point.space.names, model.refit.std, strict=True))
    least = np.log(len(model.refit.point.log))
    far: dict[tuple[str, str], float] = {}
    for name, std in zip(nominal.names, nominal.std, strict=True):
        at = nominal.deviants.get(name)
        if at is not None and at not in has:
            group = groups.get(name, "")
            beside = nominal.groups[group] if group in nominal.names else ()  # of a common value
            off = _distance(values[name], [values[n] for n in beside if n != name]) / std
            beyond = (off - task.options.max_scatter) * std
            if beyond > 0 and beyond**2 * (known[name] ** -2 - std**-2) > least:
                far[at] = max(off, far.get(at, 0.0))
    effects = {effect.name: effect for effect in task.effects}
    listed = [at for at in sorted(far, key=lambda at: -far[at]) if at[0] in effects]
    return tuple(Candidate(effects[name], where, {}) for name, where in listed)


def _distance(value: float, others: Sequence[float]) -> float:
    """Returns how far a part is from n others: |N(0, s²)| where all scatter alike with an std s.

    A part without a common value, such as a point that is not where the drawing has it, is so far
    from zero.
    """
    if not others:
        return abs(value)
    return float(abs(value - np.mean(others)) / np.sqrt(1 + 1 / len(others)))


def accept_deviants(
    task: DiscoveryTask, model: FittedModel, most: int, progress: Progress
) -> tuple[FittedModel, tuple[AcceptedEffect, ...]]:
    """Returns the model with all parts within bounds, and effects of those that deviate farther.

    All of them become effects at once, where the fit with free parts has ended; then one after the
    other is taken out again, the nearest first, and stays out where it is not needed. The common
    values are free again once all have been tried.

    Args:
        task: what is asked.
        model: a fit in which parts are free.
        most: how many effects may be accepted.
        progress: is told a line per effect.

    Returns:
        The model without these effects, its parts within bounds, and the effects that unseen
        samples confirm against it; without any, the model as it was.
    """
    candidates = find_deviants(task, model)[:most]
    if not candidates:
        return model, ()
    task = within_bounds(task)
    start = _as_effects(task.nominal_model, candidates, model.refit.point.values)
    more = (*model.candidates, *candidates)
    best = try_fit(task, more, start, model, tried=candidates[0])
    kept: list[tuple[Candidate, Proof, float]] = []
    parent, bound = best, task
    for candidate in reversed(candidates):
        if best is None:
            return model, ()
        tighter, values = _without(bound, (candidate,), best)
        parent = _fit_without(tighter, (candidate,), values, best)
        if parent is None:
            return model, ()
        proof = prove(parent.validation, best.validation, task.options)
        gain = best.negative_bic - parent.negative_bic
        progress(f"{candidate.effect.name}, {candidate.where}: deviates, gain {gain:z.0f}")
        if gain > 0 and is_confirmed(proof, task.options, len(candidates)):
            kept.insert(0, (candidate, proof, gain))
        else:
            best, bound = parent, tighter
    out = [candidate for candidate, *_ in kept]
    if not kept or best is None:
        return model, ()
    if bound is not task:
        best = try_fit(task, best.candidates, best.refit.point.values, best)
    if best is not None and (bound is not task or out != [*candidates[:1]]):
        tighter, values = _without(task, out, best)
        parent = _fit_without(tighter, out, values, best)
    if best is None or parent is None:
        return model, ()
    accepted = []
    for candidate, proof, gain in kept:
        others = tuple(c for c in best.candidates if c is not candidate)
        mine = replace(best, candidates=(*others, candidate))
        accepted.append(AcceptedEffect(mine, proof, gain, ()))
    return parent, tuple(accepted)


def _without(
    task: DiscoveryTask, candidates: Sequence[Candidate], model: FittedModel
) -> tuple[DiscoveryTask, dict[str, float]]:
    """Returns the task with its common values held, and values where parts are within bounds."""
    nominal, values = task.nominal_model, dict(model.refit.point.values)
    std = dict(zip(nominal.names, nominal.std, strict=True))
    for candidate in candidates:
        own = [n for n, at in nominal.deviants.items() if at == candidate.key]
        for size, name in zip(candidate.sizes, own, strict=True):
            far = task.options.max_scatter * std[name]
            values[name] = float(np.clip(values[name] + values.pop(size), -far, far))
    return _with_common_held(task, candidates, values), values


def _fit_without(
    task: DiscoveryTask, candidates: Sequence[Candidate], values: Mapping[str, float],
    model: FittedModel,
) -> FittedModel | None:  # fmt: skip
    """Returns a fit of the model without some effects.

    A robot without a part that is off cannot be, and its fit wanders: where few steps leave it far
    behind, it has no more. None where it cannot be simulated.
    """
    out = {candidate.key for candidate in candidates}
    rest = tuple(c for c in model.candidates if c.key not in out)
    few = try_fit(task, rest, values, model, ROUGH_FIT_STEPS)
    count = sum(len(candidate.sizes) for candidate in candidates)
    far = NEEDED_BIC_RATIO * count * float(np.log(len(model.refit.point.log)))
    if few is None or few.negative_bic < model.negative_bic - far:
        return few
    return try_fit(task, rest, few.refit.point.values, few)


def _with_common_held(
    task: DiscoveryTask, candidates: Sequence[Candidate], values: Mapping[str, float]
) -> DiscoveryTask:
    """Returns the task with common values of some parts held where all other parts have them."""
    nominal, options = task.nominal_model, task.options
    std = dict(zip(nominal.names, nominal.std, strict=True))
    out = {candidate.key for candidate in candidates}
    held = dict(nominal.held)
    for common, names in nominal.groups.items():
        others = [name for name in names if nominal.deviants.get(name) not in out]
        if common in std and common not in names and 0 < len(others) < len(names):
            beyond = np.sqrt(1 + 1 / len(others)) - 1
            room = float(np.exp(options.max_scatter * std[names[0]] * beyond))
            held[common] = values[common] / room, values[common] * room
    return replace(task, nominal_model=replace(nominal, held=held))


def _as_effects(
    model: NominalModel, candidates: tuple[Candidate, ...], values: Mapping[str, float]
) -> dict[str, float]:
    """Returns the values with the deviations of some parts as sizes of their effects."""
    out = dict(values)
    for candidate in candidates:
        own = [n for n, at in model.deviants.items() if at == candidate.key]
        for size, name in zip(candidate.sizes, own, strict=True):
            out[size], out[name] = values[name], 0.0
    return out


def within_bounds(task: DiscoveryTask) -> DiscoveryTask:
    """Returns the task in which no part deviates by more than parts do."""
    return replace(task, nominal_model=replace(task.nominal_model, is_bounded=True))
