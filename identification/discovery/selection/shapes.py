"""The best refit of an effect, looked at again: another start, another shape, the usual shape.

Where it leaves structure its next likely shape is tried, and for a first effect a start at the
nominal values. Where the data hardly tell its kind from the usual one, the usual one is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from identification.discovery.findings.input_error import find_input_error
from identification.discovery.fitted_model import FittedModel, try_fit
from identification.discovery.nominal_model import NominalModel
from identification.discovery.scoring.scores import Score
from identification.effects.effect import Candidate
from identification.kalman.innovations import innovation_tests
from identification.logs.log import Log

BARE = 2.0  # of BIC, below which a difference is hardly worth a mention (Kass, Raftery 1995)


def improved(
    base: NominalModel, whole: Log, step: FittedModel, best: FittedModel, ranked: Sequence[Score]
) -> FittedModel:
    """The best refit of the last candidate, or a better one of the same effect.

    Args:
        base: the nominal model.
        whole: the log.
        step: the model without the candidate.
        best: the model with it.
        ranked: scores of all candidates on `step`.
    """
    if structured(best):
        other = _other_shape(base, whole, step, best, ranked)
        if not step.candidates and (other is best or structured(other)):
            other = _from_nominal(base, whole, step, other)
        best = other
    return _as_usual(base, whole, step, best, ranked)


def structured(step: FittedModel) -> bool:
    """Whether innovations are not white, or what the noise model takes for chance is none."""
    white = innovation_tests(step.innovations, step.refit.point.log.sampling_time)
    return white.correlated or bool(find_input_error(step))


def _from_nominal(
    base: NominalModel, whole: Log, step: FittedModel, best: FittedModel
) -> FittedModel:
    """The better of a fit and of one that begins at the nominal values.

    A wrong model may have led the base parameters astray, too far to come back.
    """
    old = {n: step.refit.point.values[n] for c in step.candidates for n in c.free}
    new = {n: best.refit.point.values[n] for n in best.candidates[-1].free}
    again = try_fit(base, whole, best.candidates, {**old, **new})
    return max(best, again or best, key=_criterion)


def _other_shape(
    base: NominalModel, whole: Log, step: FittedModel, best: FittedModel, ranked: Sequence[Score]
) -> FittedModel:
    """The better of a fit and of one whose fixed shapes (a power, a kind) are the next likely."""
    mine = best.candidates[-1]
    fixed = [shape.name for shape in mine.effect.shapes if not shape.free]
    for s in _same(mine, ranked):
        if any(s.candidate.shape[name] != mine.shape[name] for name in fixed):
            return max(best, _shaped(base, whole, step, s) or best, key=_criterion)
    return best


def _as_usual(
    base: NominalModel, whole: Log, step: FittedModel, best: FittedModel, ranked: Sequence[Score]
) -> FittedModel:
    """A fit whose kinds are the usual ones, where the data hardly tell it from the best."""
    mine = best.candidates[-1]
    usual = {s.name: s.usual for s in mine.effect.shapes if not s.free and s.usual is not None}
    if all(mine.shape[name] == value for name, value in usual.items()):
        return best
    for s in _same(mine, ranked):
        if all(s.candidate.shape[name] == value for name, value in usual.items()):
            other = _shaped(base, whole, step, s)
            return other if other and best.criterion - other.criterion < BARE else best
    return best


def _same(mine: Candidate, ranked: Sequence[Score]) -> Iterator[Score]:
    """Scores of an effect at its place, whatever the shape."""
    for s in ranked:
        if s.candidate.effect.name == mine.effect.name and s.candidate.where == mine.where:
            yield s


def _shaped(base: NominalModel, whole: Log, step: FittedModel, s: Score) -> FittedModel | None:
    """A model with a candidate fitted; None where that cannot be simulated."""
    sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
    more = (*step.candidates, s.candidate)
    return try_fit(base, whole, more, {**step.refit.point.values, **sizes}, step)


def _criterion(step: FittedModel) -> float:
    return step.criterion
