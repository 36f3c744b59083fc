"""The next effect of a model: the best candidates are refitted, the most likely one is proved.

Of those that were refitted the most likely one is chosen, by BIC, and accepted when unseen data say
so too: beyond chance and, but for a first effect that leaves nothing else to explain, by enough to
matter; a second name is often but the wrong shape of the first. Where no score is beyond chance but
inputs are said to err, the best are refitted all the same, and must then gain beyond chance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from scipy.stats import chi2

from identification.discovery.findings.input_error import find_input_error
from identification.discovery.findings.location import find_structure
from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    collect_parameters,
    fit_model,
    is_confirmed,
    is_proven,
)
from identification.discovery.nominal_model import NominalModel
from identification.discovery.proof import prove
from identification.discovery.result import Tried
from identification.discovery.scoring.scores import Score
from identification.discovery.scoring.significance import ALPHA, plausible, significant
from identification.discovery.selection.shapes import improved
from identification.errors import DivergenceError, InputError
from identification.logs.log import Log

CONTENDERS = 3  # explanations that are refitted at most
CLOSE = 0.3  # share of the best gain that makes a contender
ELSEWHERE = 0.7  # share of an effect's best gain that makes another place a contender


def select_effect(
    base: NominalModel,
    whole: Log,
    step: FittedModel,
    ranked: Sequence[Score],
    say: Callable[[str], None],
) -> tuple[AcceptedEffect | None, tuple[Tried, ...], FittedModel | None]:
    """The best effect to add to a model, if any is worth it; else those that were not.

    Returns:
        the effect; what was tried; and of that the likeliest model that foretells unseen samples,
        though its free run is no nearer.
    """
    tried: list[FittedModel] = []
    contenders = _contenders(significant(ranked))
    hidden = not contenders and not step.candidates and bool(step.refit.level.noise.ratio)
    for s in _likeliest(ranked) if hidden else contenders:
        sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
        more = (*step.candidates, s.candidate)
        try:
            new = fit_model(base, whole, more, {**step.refit.point.values, **sizes}, step)
        except (DivergenceError, InputError) as error:
            say(f"{s.candidate.effect.name}, {s.candidate.where}: left out, {error}")
            continue
        gain = new.criterion - step.criterion
        say(f"{s.candidate.effect.name}, {s.candidate.where}: gain {gain:.0f}")
        if not hidden or _beyond_chance(new, step, len(ranked)):
            tried.append(new)
    tried.sort(key=lambda new: new.criterion, reverse=True)
    if tried:
        tried[0] = improved(base, whole, step, tried[0], ranked)
    rejected: list[Tried] = []
    hopeful: FittedModel | None = None
    clean = not step.candidates and not find_structure(step)
    for k, new in enumerate(tried):
        proof = prove(step.validation, new.validation)
        gain = new.criterion - step.criterion
        if gain > 0 and (
            is_confirmed(proof) or (clean and is_proven(proof) and not find_input_error(new))
        ):
            return AcceptedEffect(new, proof, gain, tuple(tried[:k] + tried[k + 1 :])), (), None
        if gain > 0 and is_proven(proof) and hopeful is None:
            hopeful = new
        mine = new.candidates[-1]
        rejected.append(Tried(mine, collect_parameters(base, new, mine), gain, proof))
    return None, tuple(rejected), hopeful


def _likeliest(ranked: Sequence[Score]) -> list[Score]:
    """What may hide as an error of the inputs: the best of few effects, whose scores are luck.

    Base parameters that were bent for want of an effect lie too far for a score, which is linear.
    """
    best: dict[str, Score] = {}
    for s in ranked:
        if s.gain > 0 and plausible(s.candidate, s.size):
            best.setdefault(s.candidate.effect.name, s)
    return [*best.values()][:CONTENDERS]


def _beyond_chance(new: FittedModel, step: FittedModel, n: int) -> bool:
    """Whether a refit gains more than the best of n candidates does by luck."""
    more = len(new.refit.point.q) - len(step.refit.point.q)
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
