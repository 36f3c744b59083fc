"""The next effect of a model: the best candidates are refitted, the most likely one is proved.

Of those that were refitted the most likely one is chosen, by BIC, and accepted when unseen data say
so too: beyond chance and, but for a first effect that leaves nothing else to explain, by enough to
matter; a second name is often but the wrong shape of the first. Where the best leaves structure,
its next likely shape is tried, and for a first effect a start at the nominal values. Where no score
is beyond chance but inputs are said to err, the best are refitted all the same, and must then gain
beyond chance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from scipy.stats import chi2

from identification.discovery.along import goes_along
from identification.discovery.extend import Base
from identification.discovery.locate import left_over
from identification.discovery.proof import prove
from identification.discovery.result import Tried
from identification.discovery.score import Score
from identification.discovery.significant import ALPHA, plausible, significant
from identification.discovery.steps import (
    Accepted,
    Step,
    fitted,
    holds,
    parameters_of,
    proven,
)
from identification.errors import DivergenceError, InputError
from identification.kalman.innovations import whiteness
from identification.log import Log

CONTENDERS = 3  # explanations that are refitted at most
CLOSE = 0.3  # share of the best gain that makes a contender
ELSEWHERE = 0.7  # share of an effect's best gain that makes another place a contender


def add(
    base: Base, whole: Log, step: Step, ranked: Sequence[Score], say: Callable[[str], None]
) -> tuple[Accepted | None, tuple[Tried, ...]]:
    """The best effect to add to a model, if any is worth it, and those that were not."""
    tried: list[Step] = []
    contenders = _contenders(significant(ranked))
    hidden = not contenders and not step.candidates and bool(step.refit.level.noise.ratio)
    for s in _likeliest(ranked) if hidden else contenders:
        sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
        more = (*step.candidates, s.candidate)
        try:
            new = fitted(base, whole, more, {**step.refit.at.values, **sizes}, step)
        except (DivergenceError, InputError) as error:
            say(f"{s.candidate.effect.name}, {s.candidate.where}: left out, {error}")
            continue
        gain = new.criterion - step.criterion
        say(f"{s.candidate.effect.name}, {s.candidate.where}: gain {gain:.0f}")
        if not hidden or _beyond_chance(new, step, len(ranked)):
            tried.append(new)
    tried.sort(key=_criterion, reverse=True)
    if tried and _structured(tried[0]):
        tried[0] = _other_shape(base, whole, step, tried[0], ranked)
    if tried and not step.candidates and _structured(tried[0]):
        tried[0] = _from_nominal(base, whole, step, tried[0])
    rejected: list[Tried] = []
    clean = not step.candidates and not left_over(step)
    for k, new in enumerate(tried):
        proof = prove(step.unseen, new.unseen)
        gain = new.criterion - step.criterion
        if gain > 0 and (holds(proof) or (clean and proven(proof))):
            return Accepted(new, proof, gain, tuple(tried[:k] + tried[k + 1 :])), ()
        mine = new.candidates[-1]
        rejected.append(Tried(mine, parameters_of(base, new, mine), gain, proof))
    return None, tuple(rejected)


def _likeliest(ranked: Sequence[Score]) -> list[Score]:
    """What may hide as an error of the inputs: the best of few effects, whose scores are luck.

    Base parameters that were bent for want of an effect lie too far for a score, which is linear.
    """
    best: dict[str, Score] = {}
    for s in ranked:
        if s.gain > 0 and plausible(s.candidate, s.size):
            best.setdefault(s.candidate.effect.name, s)
    return [*best.values()][:CONTENDERS]


def _beyond_chance(new: Step, step: Step, n: int) -> bool:
    """Whether a refit gains more than the best of n candidates does by luck."""
    more = len(new.refit.at.q) - len(step.refit.at.q)
    gain = 2 * (new.refit.log_posterior - step.refit.log_posterior)
    return bool(chi2.sf(gain, more) * n < ALPHA)


def _contenders(found: Sequence[Score]) -> list[Score]:
    """The few best of what is significant; one effect in two places only where both are near."""
    best: dict[str, float] = {}
    out = []
    for s in found:
        if s.gain > max(CLOSE * found[0].gain, ELSEWHERE * best.get(s.candidate.effect.name, 0.0)):
            out.append(s)
            best.setdefault(s.candidate.effect.name, s.gain)
    return out[:CONTENDERS]


def _criterion(step: Step) -> float:
    return step.criterion


def _structured(step: Step) -> bool:
    """Whether innovations are not white, or what the noise model takes for chance is none."""
    white = whiteness(step.innovations, step.refit.at.log.sampling_time)
    return white.correlated or bool(goes_along(step))


def _from_nominal(base: Base, whole: Log, step: Step, best: Step) -> Step:
    """The better of a fit and of one that begins at the nominal values.

    A wrong model may have led the base parameters astray, too far to come back.
    """
    old = {n: step.refit.at.values[n] for c in step.candidates for n in c.free}
    new = {n: best.refit.at.values[n] for n in best.candidates[-1].free}
    try:
        return max(best, fitted(base, whole, best.candidates, {**old, **new}), key=_criterion)
    except (DivergenceError, InputError):
        return best


def _other_shape(base: Base, whole: Log, step: Step, best: Step, ranked: Sequence[Score]) -> Step:
    """The better of a fit and of one whose fixed shapes (a power, a kind) are the next likely."""
    mine = best.candidates[-1]
    fixed = [shape.name for shape in mine.effect.shapes if not shape.free]
    for s in ranked:
        c = s.candidate
        same = c.effect.name == mine.effect.name and c.where == mine.where
        if same and any(c.shape[name] != mine.shape[name] for name in fixed):
            sizes = dict(zip(c.sizes, s.size, strict=True))
            start = {**step.refit.at.values, **sizes}
            try:
                other = fitted(base, whole, (*step.candidates, c), start, step)
            except (DivergenceError, InputError):
                return best
            return max(best, other, key=_criterion)
    return best
