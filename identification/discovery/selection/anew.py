"""Refits of a first effect that begin anew at the nominal values, each in each of its kinds.

Where much is missing, the nominal fit moves a parameter to the end of what is plausible to make up
for it, and refits that begin there stay there: the likeliest of them is then the effect that goes
best with a wrong parameter. All of them begin anew, because one that did so alone would win by its
start.
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.fitted_model import FittedModel, list_parameters_at_limit, try_fit
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.significance import gain_of_whole
from identification.discovery.task import DiscoveryTask
from identification.effects.effect import Candidate


def begin_anew(
    task: DiscoveryTask, refitted: Sequence[FittedModel], scores: Sequence[Score]
) -> list[FittedModel]:
    """Returns refits of a first effect, or better ones that began at the nominal values.

    Nothing changes where the likeliest refit has no parameter at a limit.

    Args:
        task: the nominal model, the log and the options.
        refitted: models with one effect each, the likeliest first.
        scores: of all candidates on the model without effects.

    Returns:
        For each of these effects the likeliest model, the likeliest effect first.
    """
    if not refitted or not list_parameters_at_limit(refitted[0]):
        return [*refitted]
    best = [_likeliest(task, model, scores) for model in refitted]
    return sorted(best, key=lambda model: model.negative_bic, reverse=True)


def _likeliest(task: DiscoveryTask, model: FittedModel, scores: Sequence[Score]) -> FittedModel:
    """Returns the likeliest of a refit and of those begun at the nominal values, in each kind."""
    best, mine = model, model.candidates[-1]
    for s in _best_of_each_kind(mine, scores):
        sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
        new = try_fit(task, (s.candidate,), {**s.candidate.fixed, **sizes}, tried=s.candidate)
        if new is not None and new.negative_bic > best.negative_bic:
            best = new
    return best


def _best_of_each_kind(mine: Candidate, scores: Sequence[Score]) -> list[Score]:
    """Returns the best score of an effect at its place in each kind, which is no free shape."""
    kinds = [shape.name for shape in mine.effect.shapes if not shape.free]
    best: dict[tuple[float, ...], Score] = {}
    for s in sorted(scores, key=gain_of_whole, reverse=True):
        if s.candidate.key == mine.key:
            best.setdefault(tuple(s.candidate.shape[name] for name in kinds), s)
    return [*best.values()]
