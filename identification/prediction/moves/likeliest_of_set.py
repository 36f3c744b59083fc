"""The likeliest effect of a set of names is the one that the model has.

An effect is accepted among what was refitted beside it at that time. Later effects change the odds,
and so do resamples: the accepted one may keep 8 %, and a rival have the rest. Where a rival has the
larger share it is refitted in the effect's place, and takes it if unseen records prove it there.
"""

from __future__ import annotations

from dataclasses import replace

from identification.discovery.passes import uses
from identification.prediction.crossing import at_all_lengths
from identification.prediction.extension import refitted
from identification.prediction.model import WindowModel
from identification.prediction.moves.add_set import with_one
from identification.prediction.odds import find_odds
from identification.prediction.selection import judged
from identification.prediction.task import Change, WindowSearch
from identification.prediction.trial import Contender
from identification.progress import Progress


def likeliest_of_set(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model with the likeliest effect of each set of names in its place."""
    model, out = state.model, list[Contender]()
    for old in state.accepted:
        odds = find_odds(old, model)
        rival = odds.likeliest
        is_likelier = rival is not None and rival[1] > odds.own
        new = _in_its_place(state, model, old, rival[0]) if rival and is_likelier else None
        if new is None:
            out.append(old)
            continue
        progress(f"{_label(new)}: likelier than {_label(old)}")
        model = new.model
        out.append(new)
    return model, tuple(out), ()


def _in_its_place(
    state: WindowSearch, model: WindowModel, old: Contender, rival: Contender
) -> Contender | None:
    """Returns a rival that was refitted in an effect's place; None where it is not proven there.

    Args:
        state: whose data are fitted.
        model: with the effect.
        old: the effect.
        rival: which is likelier.
    """
    task, options = state.task, state.task.options
    rest = [c for c in model.candidates if c.key != old.candidate.key]
    without = refitted(model, rest, task.nominal_model, task.confirm)
    new = with_one(state, without, rival.candidate) if without else None
    if without is None or new is None:
        return None
    crosses = uses(options, "states_of_others")
    parent, (whole,) = at_all_lengths(without, [new], task.horizon, task.confirm, crosses)
    if whole is None:
        return None
    found = judged(parent, whole, 1 + len(old.alternatives), options)
    others = [o for o in old.alternatives if o is not rival]
    return replace(found, alternatives=(old, *others)) if found.is_proven else None


def _label(c: Contender) -> str:
    return f"{c.candidate.effect.name}, {c.candidate.where}"
