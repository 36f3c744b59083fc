"""A second look at the best refits of an effect: another start, another shape, the usual shape.

Where a refit leaves structure in the innovations, its next likely shape is tried; a first effect
is also fitted from the nominal values. Where the data do not tell two shapes apart, the usual one
is taken.

Where much is missing, the nominal fit moves a parameter to the end of what is plausible to make up
for it, and refits that begin there stay there: the likeliest of them is then the effect that goes
best with a wrong parameter. All refits then begin anew at the nominal values, because one that did
so alone would win by its start.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.estimation.residuals import innovation_tests
from identification.innovations.fitted_model import FittedModel, list_parameters_at_limit, try_fit
from identification.innovations.input_error import find_input_error
from identification.innovations.scoring.scores import Score
from identification.innovations.scoring.significance import gain_of_whole
from identification.innovations.task import DiscoveryTask

# Of two shapes whose BIC differ by less, the usual one is taken: the difference is not worth more
# than a bare mention (Kass and Raftery 1995).
BARE_BIC = 2.0


def improve_shape(
    task: DiscoveryTask, model: FittedModel, best: FittedModel, scores: Sequence[Score]
) -> FittedModel:
    """Returns the best refit of an effect, or a better one of the same effect with another shape.

    Args:
        task: the nominal model, the log and the options.
        model: the model without the effect.
        best: the model with it; the effect is the last of its candidates.
        scores: of all candidates on `model`.
    """
    if is_structured(best, task.options):
        other = _try_other_shape(task, model, best, scores)
        if not model.candidates and (other is best or is_structured(other, task.options)):
            other = _try_from_nominal(task, model, other)
        best = other
    return _prefer_usual(task, model, best, scores)


def is_structured(model: FittedModel, options: DiscoveryOptions) -> bool:
    """Returns whether the innovations are not white, or the inputs' error is not random."""
    white = innovation_tests(model.innovations, model.refit.point.log.sampling_time)
    level, share = options.structure_level, options.min_structure_share
    return white.is_correlated(level, share) or bool(find_input_error(model.validation, options))


def _try_from_nominal(task: DiscoveryTask, model: FittedModel, best: FittedModel) -> FittedModel:
    """Returns the better of a fit and of the same fit begun at the nominal values.

    The wrong model may have moved the parameters too far away to come back.
    """
    old = {n: model.refit.point.values[n] for c in model.candidates for n in c.free}
    new = {n: best.refit.point.values[n] for n in best.candidates[-1].free}
    least, mine = best.refit.log_posterior, best.candidates[-1]
    again = try_fit(task, best.candidates, {**old, **new}, least=least, tried=mine)
    return max(best, again or best, key=_negative_bic)


def _try_other_shape(
    task: DiscoveryTask, model: FittedModel, best: FittedModel, scores: Sequence[Score]
) -> FittedModel:
    """Returns the better of a fit and one with the next likely fixed shapes (a power, a kind)."""
    mine = best.candidates[-1]
    fixed = [shape.name for shape in mine.effect.shapes if not shape.free]
    for s in _select_same(mine, scores):
        if any(s.candidate.shape[name] != mine.shape[name] for name in fixed):
            other = _fit_shape(task, model, s, best.refit.log_posterior)
            return max(best, other or best, key=_negative_bic)
    return best


def _prefer_usual(
    task: DiscoveryTask, model: FittedModel, best: FittedModel, scores: Sequence[Score]
) -> FittedModel:
    """Returns the fit with the usual fixed shapes, where the data do not tell it from the best."""
    mine = best.candidates[-1]
    usual = {s.name: s.usual for s in mine.effect.shapes if not s.free and s.usual is not None}
    if all(mine.shape[name] == value for name, value in usual.items()):
        return best
    for s in _select_same(mine, scores):
        if all(s.candidate.shape[name] == value for name, value in usual.items()):
            least = best.refit.log_posterior - BARE_BIC / 2
            other = _fit_shape(task, model, s, least)
            if other and best.negative_bic - other.negative_bic < BARE_BIC:
                return other
            return best
    return best


def _select_same(mine: Candidate, scores: Sequence[Score]) -> Iterator[Score]:
    """Yields the scores of the same effect at the same place, with any shape, the best first."""
    for s in sorted(scores, key=gain_of_whole, reverse=True):
        if s.candidate.effect.name == mine.effect.name and s.candidate.where == mine.where:
            yield s


def _fit_shape(
    task: DiscoveryTask, model: FittedModel, s: Score, least: float
) -> FittedModel | None:
    """Returns the model with a candidate of another shape; None where it cannot be simulated.

    One that does not come to the log posterior `least` does not matter, and its fit ends early.
    """
    sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
    more = (*model.candidates, s.candidate)
    start = {**model.refit.point.values, **sizes}
    return try_fit(task, more, start, model, least=least, tried=s.candidate)


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


def _negative_bic(model: FittedModel) -> float:
    return model.negative_bic
