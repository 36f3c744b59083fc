"""Second thoughts: once several effects are named, is each still needed, and still the right one?

backward: an effect is dropped when the model without it has the better BIC
swap:     an effect gives way to one that was refitted in its place, or that scores as well beside
          the others, when that one has the better BIC now that the others are known
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    is_confirmed,
    score_candidates,
    try_fit,
)
from identification.discovery.nominal_model import NominalModel
from identification.discovery.proof import prove
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.discovery.scoring.significance import LIKE, significant
from identification.discovery.selection.forward_selection import CONTENDERS
from identification.effects.effect import Candidate
from identification.logs.log import Log

HOPELESS = 0.5  # share of an effect's gain that a rival must have had to be tried again


def backward(
    base: NominalModel, log: Log, accepted: Sequence[AcceptedEffect], step: FittedModel
) -> tuple[list[AcceptedEffect], FittedModel]:
    """Drop effects that those found later have made needless; the last one was just proved."""
    kept = list(accepted)
    for old in accepted[:-1]:
        mine = old.step.candidates[-1]
        rest = tuple(c for c in step.candidates if c is not mine)
        without = try_fit(base, log, rest, step.refit.point.values, step)
        if without is not None and without.criterion > step.criterion:
            kept, step = [a for a in kept if a is not old], without
    return kept, step


def swap(
    base: NominalModel,
    log: Log,
    nominal: FittedModel,
    accepted: Sequence[AcceptedEffect],
    step: FittedModel,
    columns: Sequence[Sensitivity],
) -> tuple[list[AcceptedEffect], FittedModel]:
    """Let the near rivals of each effect try its place among the others."""
    kept = list(accepted) if len(accepted) > 1 else []
    for i, old in enumerate(kept):
        mine = old.step.candidates[-1]
        rest = tuple(c for c in step.candidates if c is not mine)
        for theirs, start in _rivals(base, log, old, rest, step, columns):
            if any(theirs.effect.name == c.effect.name for c in rest):
                continue
            new = try_fit(base, log, (*rest, theirs), {**step.refit.point.values, **start}, step)
            if new is None:
                continue
            proof = prove(nominal.validation, new.validation)
            if new.criterion > step.criterion and is_confirmed(proof):
                others = (replace(step, candidates=(*rest, mine)),)
                gain = old.gain + new.criterion - step.criterion
                kept[i] = AcceptedEffect(new, old.proof, gain, others)
                step = new
                break
    return kept or list(accepted), step


def _rivals(
    base: NominalModel,
    log: Log,
    old: AcceptedEffect,
    rest: tuple[Candidate, ...],
    step: FittedModel,
    columns: Sequence[Sensitivity],
) -> list[tuple[Candidate, Mapping[str, float]]]:
    """What may stand in an effect's place, each with values to begin at."""
    mine = old.step.candidates[-1]
    out: dict[tuple[str, str], tuple[Candidate, Mapping[str, float]]] = {
        _key(r.candidates[-1]): (r.candidates[-1], r.refit.point.values)
        for r in old.others
        if old.step.criterion - r.criterion <= HOPELESS * old.gain
    }
    without = try_fit(base, log, rest, step.refit.point.values, step)
    scores = [] if without is None else significant(score_candidates(without, columns))
    own = next((s.gain for s in scores if _key(s.candidate) == _key(mine)), 0.0)
    for s in scores:
        if s.gain > LIKE * own and _key(s.candidate) != _key(mine):
            sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
            out.setdefault(_key(s.candidate), (s.candidate, sizes))
    return list(out.values())[:CONTENDERS]


def _key(candidate: Candidate) -> tuple[str, str]:
    return candidate.effect.name, candidate.where
