"""The likeliest effect of a set of names is the one that the model has.

An effect is accepted among what was refitted beside it at that time. Later effects change the odds:
a mass of three bodies, which physics forbids, may be likelier than that of one as long as it also
imitates what is found next. So after each effect that is found, an earlier one that is not the
likeliest is asked again: it and the others are refitted in its place, beside all that was found
since. The likeliest that unseen records prove there takes the place, and the odds are those of
these refits. A difference between records takes the place of no law: it is no name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from identification.discovery.passes import uses
from identification.prediction.crossing import at_all_lengths
from identification.prediction.evidence import compute_confidence
from identification.prediction.extension import refitted
from identification.prediction.judging import judged
from identification.prediction.model import WindowModel
from identification.prediction.moves.add_set import with_one
from identification.prediction.odds import find_odds
from identification.prediction.smooth_rivals import without_imitated
from identification.prediction.task import Change, WindowSearch
from identification.prediction.trial import Contender, evidences, is_rival
from identification.progress import Progress


def likeliest_of_set(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model with the likeliest effect of each set of names in its place."""
    model, out = state.model, list[Contender]()
    for old in state.accepted:
        odds = find_odds(old, model)
        is_forbidden = odds.forbidden > odds.own and old is not state.accepted[-1]
        # what unseen records do not prove takes no place, however likely it is
        proven = [p for rival, p in odds.rivals if rival.is_proven and _may_replace(rival, old)]
        is_likelier = max(proven, default=0.0) > odds.own
        new = _asked_again(state, model, old) if is_likelier or is_forbidden else None
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
    each = [with_one(state, without, c.candidate) for c in (old, *old.alternatives)]
    found = _judged_together(state, without, [c for c in each if c is not None])
    if not any(c.is_proven and _may_replace(c, old) for c in found):
        return None
    shares = compute_confidence(evidences(found))
    pairs = [(c, p) for c, p in zip(found, shares, strict=True) if _may_replace(c, old)]
    best, _ = max(pairs, key=lambda pair: (pair[0].is_proven, pair[1]))
    others = (o for o in found if o is not best and is_rival(o))
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


def _may_replace(new: Contender, old: Contender) -> bool:
    """Returns whether an effect may take the place of another: a difference only that of one."""
    return old.candidate.effect.is_of_records or not new.candidate.effect.is_of_records


def _label(c: Contender) -> str:
    return f"{c.candidate.effect.name}, {c.candidate.where}"
