"""One curve of the data instead of several laws that were found at one joint.

A cause that is in no catalogue may be put together from laws: a place where something catches, from
a friction that differs by direction and a cogging. If one curve, in the place of all laws at the
joint, has more evidence for it than they have, their cause is unlisted: they are told and not
named. Laws that are there have the evidence of their few numbers, which a curve has not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.prediction.contenders import count_numbers
from identification.prediction.evidence import all_gains, count_windows, evidence
from identification.prediction.extension import refitted
from identification.prediction.screening import places_of, score_all
from identification.prediction.selection import refit_contenders
from identification.prediction.task import Change, WindowSearch
from identification.prediction.trial import Contender
from identification.prediction.yardstick import ON_JOINTS
from identification.progress import Progress


def curve_for_laws(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model with a curve in place of several laws, if it has more evidence."""
    task, model, accepted = state.task, state.model, [*state.accepted]
    options, confirm = task.options, task.confirm
    curves, lost = [e for e in task.effects if e.is_curve], list[Contender]()
    for where in _joints_of_several(accepted):
        laws = [a for a in accepted if a.candidate.where == where and _is_law(a)]
        out = {a.candidate.key for a in laws}
        rest = [c for c in model.candidates if c.key not in out]
        bare = refitted(model, rest, task.nominal_model, confirm)
        if bare is None:
            continue
        scores = [s for s in score_all(bare, curves, options) if s.candidate.where == where]
        refit = partial(refit_contenders, bare, scores, task.horizon, confirm, options, progress)
        refitted_curves = attempt(None, refit)
        if refitted_curves is None:
            continue
        parent, tried = refitted_curves
        windows, outputs = count_windows(parent), len(parent.scale)
        numbers = sum(count_numbers(a.candidate) for a in laws)
        theirs = evidence([all_gains(parent, model)], [numbers], windows, outputs)[0, 0]
        if tried and tried[0].is_proven and tried[0].criterion > theirs:
            best = tried[0]
            progress(f"{best.candidate.effect.name}, {where}: does what {len(laws)} laws do")
            model = best.model
            accepted = [*(a for a in accepted if a not in laws), best]
            lost += [replace(a, doubt="drawn") for a in laws]
    return model, tuple(accepted), tuple(lost)


def _joints_of_several(accepted: Sequence[Contender]) -> list[str]:
    """Returns the joints at which several laws and no curve were accepted."""
    curves = {
        place
        for a in accepted
        if a.candidate.effect.is_curve
        for place in places_of(a.candidate.where)
    }
    count = Counter(a.candidate.where for a in accepted if _is_law(a))
    return [where for where, n in count.items() if n > 1 and where not in curves]


def _is_law(a: Contender) -> bool:
    """Returns whether a contender is a law of a force, which a curve may be as well."""
    effect = a.candidate.effect
    return not effect.is_curve and bool(effect.hooks) and {*effect.hooks} <= ON_JOINTS
