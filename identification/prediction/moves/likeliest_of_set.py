"""The likeliest effect of a set of names is the one that the model has.

An effect is accepted among what was refitted beside it at that time. Later effects change the odds:
a mass of three bodies, which physics forbids, may be likelier than that of one as long as it also
imitates what is found next. So after each effect that is found, an earlier one that is not the
likeliest is asked again: it and the others are refitted in its place, beside all that was found
since. The likeliest that unseen records prove there takes the place, and the odds are those of
these refits. A difference between records that is the same in all of them is a law of the robot,
which is asked in its place; another law takes it only where it is likelier.

    |a - b| < 3 √(σ_a² + σ_b²)        values a, b of any two records, and their std
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from identification.discovery.candidates import list_common, list_single
from identification.discovery.passes import uses
from identification.effects.effect import BY_RECORD, Candidate, Effect
from identification.prediction.fits.crossing import at_all_lengths
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.evidence import compute_confidence
from identification.prediction.judging.extension import refitted
from identification.prediction.judging.judging import judged
from identification.prediction.judging.odds import LATE, find_odds
from identification.prediction.judging.trial import Contender, evidences, is_rival
from identification.prediction.moves.add_set import with_one
from identification.prediction.selection.smooth_rivals import without_imitated
from identification.prediction.task import Change, WindowSearch
from identification.prediction.verdict.told_effects import fitted_sizes
from identification.runtime.progress import Progress

ALIKE = 3.0  # std by which values of two records may be apart and yet be one


def likeliest_of_set(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model with the likeliest effect of each set of names in its place."""
    model, out = state.model, list[Contender]()
    for old in state.accepted:
        odds = find_odds(old, model)
        is_forbidden = odds.forbidden > odds.own and old is not state.accepted[-1]
        # what unseen records do not prove takes no place, however likely it is
        proven = [share for rival, share in odds.rivals if rival.is_proven]
        is_likelier = max(proven, default=0.0) > odds.own
        is_asked = is_likelier or is_forbidden or is_alike(old, model)
        new = _asked_again(state, model, old) if is_asked else None
        if new is None:
            out.append(old)
            continue
        if new.candidate.key != old.candidate.key:
            progress(f"{_label(new)}: likelier than {_label(old)}")
        model = new.model
        out.append(new)
    return model, tuple(out), ()


def _asked_again(state: WindowSearch, model: WindowModel, old: Contender) -> Contender | None:
    """Returns the likeliest of an effect and its rivals, refitted in its place.

    Args:
        state: whose data are fitted.
        model: with the effect.
        old: the effect.

    Returns:
        It, with the others as its rivals; None where unseen records prove none of them there.
    """
    task = state.task
    rest = [c for c in model.candidates if c.key != old.candidate.key]
    without = refitted(model, rest, task.nominal_model, task.confirm)
    if without is None:
        return None
    must_be_law = is_alike(old, model)
    asked = [c.candidate for c in (old, *old.alternatives)]
    same = laws_of_records(old.candidate, task.effects) if must_be_law else []
    asked += same
    each = [
        with_one(state, without, c) for c in {(*c.key, str(c.shape)): c for c in asked}.values()
    ]
    found = _judged_together(state, without, [c for c in each if c is not None])
    shares = compute_confidence(evidences(found)) if found else ()
    proven = [
        (share, c) for share, c in zip(shares, found, strict=True)
        if c.is_proven and not (must_be_law and c.candidate.effect.is_of_records)
    ]  # fmt: skip
    if not proven:
        return None
    share, best = max(proven, key=lambda pair: pair[0])
    of_old = [s for s, c in zip(shares, found, strict=True) if c.candidate.key == old.candidate.key]
    is_other = best.candidate.effect.name not in {c.effect.name for c in same}
    if must_be_law and is_other and max(of_old, default=0.0) > share:
        return None  # its law is not proven, as one of outputs that are early, and no other is it
    # another shape of the same law is no rival
    others = (o for o in found if o.candidate.key != best.candidate.key and is_rival(o))
    return replace(best, alternatives=tuple(others))


def _judged_together(
    state: WindowSearch, without: WindowModel, models: Sequence[WindowModel]
) -> list[Contender]:
    """Returns models with one effect more each as contenders, over all lengths of windows."""
    task, options = state.task, state.task.options
    crosses = uses(options, "states_of_others")
    parent, whole = at_all_lengths(without, models, task.horizon, task.confirm, crosses)
    found = (judged(parent, c, len(models), options) for c in whole if c is not None)
    return [without_imitated(parent, c, options) for c in found]


def is_alike(difference: Contender, model: WindowModel) -> bool:
    """Returns whether a difference between records is none: their values are the same.

    Args:
        difference: an accepted effect; a law is no difference.
        model: with it.
    """
    if not difference.candidate.effect.is_of_records:
        return False
    of_size: dict[str, list[tuple[float, float]]] = {}
    for name, (value, std, _) in fitted_sizes(model, difference.candidate)[1].items():
        of_size.setdefault(name.partition(" [")[0], []).append((value, std))
    pairs = (pair for each in of_size.values() for pair in combinations(each, 2))
    return all(abs(a - b) < ALIKE * np.hypot(s, t) for (a, s), (b, t) in pairs)


def laws_of_records(difference: Candidate, effects: Sequence[Effect]) -> list[Candidate]:
    """Returns the law that a difference is where all records have the same value; none of a law.

    Args:
        difference: a candidate.
        effects: the catalogue.

    Returns:
        A candidate for each of its shapes.
    """
    if not difference.effect.is_of_records:
        return []
    name, where = difference.effect.name, difference.where.removesuffix(BY_RECORD)
    laws = [e for e in effects if e.name == LATE.get(name, name) and not e.own]
    return [c for c in (*list_common(laws), *list_single(list_common(laws))) if c.where == where]


def _label(c: Contender) -> str:
    return f"{c.candidate.effect.name}, {c.candidate.where}"
