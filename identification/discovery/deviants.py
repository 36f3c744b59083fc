"""Parts of a robot that deviate from the others by more than parts do: these are effects.

    |x_j| > 3 s_g          x_j: the deviation of a part in the nominal fit, s_g: the usual std

The nominal fit follows such a part, because only its prior speaks against it: nothing is left for a
candidate to explain. So, once no candidate is left to add, the deviation becomes an effect of that
part, and from here on every part is kept within three std of the others.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    fit_model,
    is_confirmed,
    try_fit,
)
from identification.discovery.nominal_model import NominalModel
from identification.discovery.proof import prove
from identification.discovery.task import DiscoveryTask
from identification.effects.effect import Candidate
from identification.estimation.options import Progress

# Steps of the fit without a part that is off. It is a robot that cannot be, and its fit
# wanders; a few steps say how far it is from the data.
FEW = 5


def find_deviants(task: DiscoveryTask, model: FittedModel) -> tuple[Candidate, ...]:
    """Effects of the parts that deviate by more than parts do, the farthest first.

    Args:
        task: with the nominal model, which knows the effect of each deviation.
        model: a fit in which parts are free.
    """
    nominal, values = task.nominal_model, model.refit.point.values
    has = {candidate.key for candidate in model.candidates}
    far: dict[tuple[str, str], float] = {}
    for name, std in zip(nominal.names, nominal.std, strict=True):
        at = nominal.deviants.get(name)
        if at is not None and at not in has:
            off = abs(values[name]) / std
            if off > task.options.max_scatter:
                far[at] = max(off, far.get(at, 0.0))
    effects = {effect.name: effect for effect in task.effects}
    known = [at for at in sorted(far, key=lambda at: -far[at]) if at[0] in effects]
    return tuple(Candidate(effects[name], where, {}) for name, where in known)


def accept_deviants(
    task: DiscoveryTask, model: FittedModel, most: int, progress: Progress
) -> tuple[FittedModel, tuple[AcceptedEffect, ...]]:
    """The model with all parts within bounds, and the effects of those that deviate farther.

    Args:
        task: what is asked.
        model: a fit in which parts are free.
        most: how many effects may be accepted.
        progress: is told a line per effect.

    Returns:
        The model without these effects, its parts within bounds, and the effects that unseen
        samples confirm against it; without any, the model as it was.

    Raises:
        DivergenceError: the robot with bounded parts cannot be simulated.
    """
    candidates = find_deviants(task, model)[:most]
    if not candidates:
        return model, ()
    task = within_bounds(task)
    start = _as_effects(task.nominal_model, candidates, model.refit.point.values)
    had = model.candidates
    parent = best = fit_model(task, had, _without(candidates, start), model, FEW)
    accepted: list[AcceptedEffect] = []
    for candidate in candidates:
        new = try_fit(task, (*best.candidates, candidate), start, model)
        if new is None:
            continue
        proof = prove(best.validation, new.validation, task.options)
        gain = new.negative_bic - best.negative_bic
        progress(f"{candidate.effect.name}, {candidate.where}: deviates, gain {gain:.0f}")
        if gain > 0 and is_confirmed(proof, task.options):
            accepted.append(AcceptedEffect(new, proof, gain, ()))
            best = new
    return parent, tuple(accepted)


def _as_effects(
    model: NominalModel, candidates: tuple[Candidate, ...], values: Mapping[str, float]
) -> dict[str, float]:
    """The values with the deviations of some parts as sizes of their effects."""
    out = dict(values)
    for candidate in candidates:
        own = [n for n, at in model.deviants.items() if at == candidate.key]
        for size, name in zip(candidate.sizes, own, strict=True):
            out[size], out[name] = values[name], 0.0
    return out


def _without(candidates: tuple[Candidate, ...], values: Mapping[str, float]) -> dict[str, float]:
    """The values without the sizes of some effects."""
    sizes = {size for candidate in candidates for size in candidate.sizes}
    return {name: value for name, value in values.items() if name not in sizes}


def within_bounds(task: DiscoveryTask) -> DiscoveryTask:
    """The task in which no part deviates by more than parts do."""
    return replace(task, nominal_model=replace(task.nominal_model, is_bounded=True))
