"""A law instead of a curve of the data, where it says as much with fewer numbers.

A fit without the effect that is missing may end far from the truth, and there the right law may
have a score that is no better than luck: it is linear, about wrong values. A curve, which can do
what any law of its quantity does, brings the other values near the truth. So laws at the joint are
scored anew where the fit with the curve has ended, as if the curve were gone:

    r = y - ŷ(θ_c, c = 0),      θ_c: all other values of the fit with the curve

The best are refitted from there. Curve and laws are judged against the model without either; a law
comes before the curve where the evidence for it, which pays for each number, is better, or not very
much worse and not told apart by resamples (`identification.prediction.selection`), and where the
curve does not predict unseen records better beyond chance.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.effects.effect import Effect
from identification.prediction.extension import left_out, refitted
from identification.prediction.model import WindowModel
from identification.prediction.screening import places_of, score_all
from identification.prediction.selection import judged, ranked, refit_contenders
from identification.prediction.task import Change, WindowSearch
from identification.prediction.trial import Contender
from identification.prediction.yardstick import acts_on_joints
from identification.progress import Progress
from identification.windows.unseen import compare


def law_for_curve(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model with laws in the place of curves that say no more than they do."""
    model, accepted, lost = state.model, state.accepted, list[Contender]()
    laws = [e for e in state.task.effects if acts_on_joints(e) and not e.is_curve]
    for curve in state.accepted:
        if not curve.candidate.effect.is_curve:
            continue
        law = _best_law(state, model, curve, laws, progress)
        if law is not None:
            c = law.candidate
            progress(f"{c.effect.name}, {c.where}: says what the curve does, with fewer numbers")
            model, accepted = law.model, (*(a for a in accepted if a is not curve), law)
            lost.append(replace(curve, doubt="numbers"))
    return model, accepted, tuple(lost)


def _best_law(
    state: WindowSearch, model: WindowModel, curve: Contender, laws: list[Effect],
    progress: Progress,
) -> Contender | None:  # fmt: skip
    """Returns the law that comes before a curve in a model; None where there is none."""
    task, key = state.task, curve.candidate.key
    rest = [c for c in model.candidates if c.key != key]
    bare = refitted(model, rest, task.nominal_model, task.confirm)
    begun = left_out(model, rest, task.nominal_model)
    if bare is None or begun is None:
        return None
    begun = replace(begun, unseen=bare.unseen)  # laws are proven against the model without either
    there, mine = {c.key for c in rest}, {*places_of(curve.candidate.where)}
    scores = [
        s for s in score_all(begun, laws, task.options)
        if s.candidate.key not in there and mine & {*places_of(s.candidate.where)}
    ]  # fmt: skip
    refit = partial(
        refit_contenders, begun, scores, task.horizon, task.confirm, task.options, progress
    )
    found = attempt(None, refit)
    tried = found[1] if found else ()
    each = [judged(bare, c.model, len(tried), task.options) for c in tried]
    last = replace(model, candidates=(*rest, *(c for c in model.candidates if c.key == key)))
    own = judged(bare, last, 1, task.options)
    first = ranked([own, *(c for c in each if c.is_proven)], task.options)[0]
    better = compare(first.model.unseen, model.unseen)  # with the curve
    if first is own or (better.is_everywhere and better.chance < task.options.significance):
        return None
    return replace(first, alternatives=tuple(c for c in each if c is not first))
