"""Parts of a robot that deviate from the others by more than parts do: these are effects.

    |x_j| > 3 s_g          x_j: the deviation of a part in the nominal fit, s_g: the usual std

The nominal fit follows such a part, because only its prior speaks against it: nothing would be left
for a candidate to explain. So the deviation becomes an effect of that part, and the nominal model,
from here on, keeps every part within three std of the others.
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

# Steps of the nominal fit without a part that is off. It is a robot that cannot be, and its fit
# wanders; a few steps say how far it is from the data.
FEW = 5


def find_deviants(task: DiscoveryTask, nominal: FittedModel) -> tuple[Candidate, ...]:
    """Effects of the parts that deviate by more than parts do, the farthest first.

    Args:
        task: with the nominal model, which knows the effect of each deviation.
        nominal: its fit, in which parts are free.
    """
    model, values = task.nominal_model, nominal.refit.point.values
    far: dict[tuple[str, str], float] = {}
    for name, std in zip(model.names, model.std, strict=True):
        if name in model.deviants:
            off = abs(values[name]) / std
            if off > task.options.max_scatter:
                at = model.deviants[name]
                far[at] = max(off, far.get(at, 0.0))
    effects = {effect.name: effect for effect in task.effects}
    known = [at for at in sorted(far, key=lambda at: -far[at]) if at[0] in effects]
    return tuple(
        Candidate(effects[name], where, {}) for name, where in known[: task.options.max_effects]
    )


def accept_deviants(
    task: DiscoveryTask, nominal: FittedModel, progress: Progress
) -> tuple[FittedModel, FittedModel, tuple[AcceptedEffect, ...]]:
    """The nominal fit with all parts within bounds, and the model with the effects of the others.

    Args:
        task: what is asked.
        nominal: the nominal fit, in which parts are free.
        progress: is told a line per effect.

    Returns:
        The nominal fit, the model with effects, and the effects; without any, the model is the
        nominal fit as it was.

    Raises:
        DivergenceError: the robot with bounded parts cannot be simulated.
    """
    candidates = find_deviants(task, nominal)
    if not candidates:
        return nominal, nominal, ()
    start = _as_effects(task.nominal_model, candidates, nominal.refit.point.values)
    model = bounded = fit_model(task, (), _without(candidates, start), nominal, FEW)
    accepted: list[AcceptedEffect] = []
    for candidate in candidates:
        new = try_fit(task, (*model.candidates, candidate), start, nominal)
        if new is None:
            continue
        proof = prove(model.validation, new.validation, task.options)
        gain = new.negative_bic - model.negative_bic
        progress(f"{candidate.effect.name}, {candidate.where}: deviates, gain {gain:.0f}")
        if gain > 0 and is_confirmed(proof, task.options):
            accepted.append(AcceptedEffect(new, proof, gain, ()))
            model = new
    return bounded, model, tuple(accepted)


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
