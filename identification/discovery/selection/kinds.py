"""Once an effect is added, those before it may be of another kind than they seemed alone.

A torque constant that falls with time looks like one that falls with heat as long as something else
is missing. So every accepted effect is compared, to first order, with its other kinds and powers,
which are no free shapes; where one of them explains more it is refitted, and the likelier model is
kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from identification.discovery.fitted_model import AcceptedEffect, FittedModel, try_fit
from identification.discovery.replacement import replace_effect
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.discovery.scoring.significance import is_plausible
from identification.discovery.task import DiscoveryTask
from identification.effects.effect import Candidate


def improve_kinds(
    task: DiscoveryTask,
    accepted: Sequence[AcceptedEffect],
    model: FittedModel,
    sensitivities: Sequence[Sensitivity],
) -> tuple[tuple[AcceptedEffect, ...], FittedModel]:
    """The accepted effects, each of the kind that is the likeliest beside the others.

    Args:
        task: the nominal model, the log and the options.
        accepted: the effects in the order in which they were added.
        model: the model with all of them.
        sensitivities: of all candidates.

    Returns:
        The effects, and the model with them.
    """
    kept = list(accepted)
    for i, old in enumerate(kept):
        for other, sizes in _list_kinds(task, old.candidate, model, sensitivities):
            candidates = tuple(other if c.key == other.key else c for c in model.candidates)
            new = try_fit(task, candidates, {**model.refit.point.values, **sizes}, model)
            if new is not None and new.negative_bic > model.negative_bic:
                # Gain and rivals stay those of the round in which it was accepted.
                begun = replace(old.model, candidates=(*old.model.candidates[:-1], other))
                kept[i], model = replace(old, model=begun), new
    return tuple(kept), model


def _list_kinds(
    task: DiscoveryTask,
    old: Candidate,
    model: FittedModel,
    sensitivities: Sequence[Sensitivity],
) -> list[tuple[Candidate, dict[str, float]]]:
    """An effect of each other kind that explains more, to first order, with its sizes."""
    best: dict[tuple[float, ...], tuple[float, Candidate, dict[str, float]]] = {}
    for s in sensitivities:
        kind = _kind(s.candidate)
        if s.candidate.key != old.key or kind == _kind(old):
            continue
        other = replace_effect(model.refit, old, s.S, model.refit.level)
        least = best[kind][0] if kind in best else 0.0
        if other.loss < least and is_plausible(s.candidate, other.size, task.options):
            sizes = dict(zip(s.candidate.sizes, other.size.tolist(), strict=True))
            best[kind] = other.loss, s.candidate, sizes
    return [(candidate, sizes) for _, candidate, sizes in best.values()]


def _kind(candidate: Candidate) -> tuple[float, ...]:
    """The shapes that are not estimated."""
    return tuple(candidate.shape[s.name] for s in candidate.effect.shapes if not s.free)
