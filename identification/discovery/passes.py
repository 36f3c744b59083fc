"""Second thoughts: once several effects are named, is each still needed, and still the right one?

backward: an effect is dropped when the model without it has the better BIC
swap:     an effect gives way to one that was refitted in its place, when that one has the better
          BIC now that the others are known
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from identification.discovery.extend import Base
from identification.discovery.proof import prove
from identification.discovery.steps import Accepted, Step, fitted, holds
from identification.effect import Candidate
from identification.errors import DivergenceError, InputError
from identification.log import Log

HOPELESS = 0.5  # share of an effect's gain that a rival must have had to be tried again


def backward(
    base: Base, log: Log, accepted: Sequence[Accepted], step: Step
) -> tuple[list[Accepted], Step]:
    """Drop effects that those found later have made needless; the last one was just proved."""
    kept = list(accepted)
    for old in accepted[:-1]:
        mine = old.step.candidates[-1]
        rest = tuple(c for c in step.candidates if c is not mine)
        without = _tried(base, log, rest, step.refit.at.values, step)
        if without is not None and without.criterion > step.criterion:
            kept, step = [a for a in kept if a is not old], without
    return kept, step


def swap(
    base: Base, log: Log, nominal: Step, accepted: Sequence[Accepted], step: Step
) -> tuple[list[Accepted], Step]:
    """Let the near rivals of each effect try its place among the others."""
    kept = list(accepted) if len(accepted) > 1 else []
    for i, old in enumerate(kept):
        mine = old.step.candidates[-1]
        rest = tuple(c for c in step.candidates if c is not mine)
        for rival in old.others:
            lost = old.step.criterion - rival.criterion
            if lost > HOPELESS * old.gain:
                continue
            theirs = rival.candidates[-1]
            if any(theirs.effect.name == c.effect.name for c in rest):
                continue
            start = {**step.refit.at.values, **rival.refit.at.values}
            new = _tried(base, log, (*rest, theirs), start, step)
            if new is None:
                continue
            proof = prove(nominal.unseen, new.unseen)
            if new.criterion > step.criterion and holds(proof):
                others = (replace(step, candidates=(*rest, mine)),)
                gain = old.gain + new.criterion - step.criterion
                kept[i] = Accepted(new, old.proof, gain, others)
                step = new
                break
    return kept or list(accepted), step


def _tried(
    base: Base, log: Log, candidates: tuple[Candidate, ...], start: Mapping[str, float], near: Step
) -> Step | None:
    """A model with some effects; None where it cannot be simulated."""
    try:
        return fitted(base, log, candidates, start, near)
    except (DivergenceError, InputError):
        return None
