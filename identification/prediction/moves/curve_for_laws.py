"""One curve of the data instead of the laws that were found at one joint.

A cause that is in no catalogue may be put together from laws: a place where something catches, from
a friction that differs by direction and a cogging. Or it gets the name of a neighbour: a brake that
acts from a speed on, that of a friction which grows with the square of the speed. One curve is
fitted in the place of all laws at the joint, and their cause is unlisted where it

    has more evidence for it than several laws have, with the price of its many numbers, or
    is proven, where a single law has a neighbour's name
    (`identification.prediction.verdict.neighbours`), and unseen records do not prove that the law
    predicts better.

That a curve predicts better than a single law is no reason by itself: no law is exact on a real
robot, and a curve also draws what lies beside the law. Laws that are there have the evidence of
their few numbers, which a curve has not. A law of a sensor or an input that has a neighbour's name
is asked at the joint of the curve that explains what it leaves.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.options import DiscoveryOptions
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.evidence import all_gains, count_windows, evidence
from identification.prediction.judging.extension import refitted
from identification.prediction.judging.trial import Contender, compared, find_doubt
from identification.prediction.scoring.contenders import count_numbers
from identification.prediction.scoring.forced import acts_on_joints
from identification.prediction.scoring.screening import places_of, score_all
from identification.prediction.selection.selection import refit_contenders
from identification.prediction.task import Change, WindowSearch
from identification.prediction.verdict.neighbours import (
    explained_by,
    find_neighbour,
    has_neighbours_name,
)
from identification.prediction.verdict.yardstick import measure
from identification.runtime.progress import Progress


def curve_for_laws(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model with a curve in place of several laws, if it has more evidence."""
    task, model, accepted = state.task, state.model, [*state.accepted]
    options, confirm = task.options, task.confirm
    neighbours = _neighbours_names(state)
    curves, lost = [e for e in task.effects if e.is_curve], list[Contender]()
    for where in _joints_of_laws(state, neighbours.values()):
        laws = [
            a for a in accepted
            if neighbours.get(a.candidate.key, a.candidate.where if _is_law(a) else "") == where
        ]  # fmt: skip
        out = {a.candidate.key for a in laws}
        rest = [c for c in model.candidates if c.key not in out]
        bare = refitted(model, rest, task.nominal_model, confirm)
        if bare is None:
            continue
        scores = [s for s in score_all(bare, curves, options) if s.candidate.where == where]
        refit = partial(
            refit_contenders, bare, scores, task.horizon, confirm, options, progress,
            are_curves=True,
        )  # fmt: skip
        refitted_curves = attempt(None, refit)
        if refitted_curves is None:
            continue
        parent, tried = refitted_curves
        best = next(iter(tried), None)
        if best is None or not best.is_proven:
            continue
        if _does_what_they_do(best, laws, parent, model, options):
            counted_laws = "a law does" if len(laws) == 1 else f"{len(laws)} laws do"
            progress(f"{best.candidate.effect.name}, {where}: does what {counted_laws}")
            model = best.model
            accepted = [*(a for a in accepted if a not in laws), best]
            lost += [replace(a, doubt="drawn") for a in laws]
    return model, tuple(accepted), tuple(lost)


def _does_what_they_do(
    curve: Contender, laws: Sequence[Contender], parent: WindowModel, model: WindowModel,
    options: DiscoveryOptions,
) -> bool:  # fmt: skip
    """Returns whether a proven curve may take the place of laws.

    Args:
        curve: beside what else is in the model.
        laws: at its joint.
        parent: the model without either.
        model: with the laws.
        options: what is beyond chance.
    """
    if len(laws) == 1:  # it has a neighbour's name
        seen = compared(curve.model.unseen, model.unseen, options)
        return find_doubt(seen, 1, options) is not None
    windows, outputs = count_windows(parent), len(parent.scale)
    numbers = sum(count_numbers(a.candidate) for a in laws)
    theirs = evidence([all_gains(parent, model, options)], [numbers], windows, outputs)[0, 0]
    return bool(curve.criterion > theirs)


def _neighbours_names(state: WindowSearch) -> dict[tuple[str, str], str]:
    """Returns laws that have the name of a neighbour of what is missing, and its curve's joint."""
    every, model = state.accepted, state.model
    if all(a.candidate.effect.is_curve for a in every):
        return {}
    stick = attempt(None, partial(measure, model, state.task.effects))
    each = (
        (a.candidate, find_neighbour(a.candidate, explained_by(a, every, model), stick))
        for a in every
    )
    return {c.key: n.where for c, n in each if n and has_neighbours_name(n, state.task.options)}


def _joints_of_laws(state: WindowSearch, doubtful: Collection[str]) -> list[str]:
    """Returns the joints of several laws, or of one that is in doubt, and of no curve."""
    curves = {
        place
        for a in state.accepted
        if a.candidate.effect.is_curve
        for place in places_of(a.candidate.where)
    }
    count = Counter(a.candidate.where for a in state.accepted if _is_law(a))
    asked = [where for where, n in count.items() if n > 1]
    return [where for where in dict.fromkeys((*asked, *doubtful)) if where not in curves]


def _is_law(a: Contender) -> bool:
    """Returns whether a contender is a law of a force, which a curve may be as well."""
    return acts_on_joints(a.candidate.effect) and not a.candidate.effect.is_curve
