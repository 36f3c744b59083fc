"""A friction that gives before it slips, fitted from its largest compliance.

    c dp/dt = v - |v| p/b        p: the friction,  b: its largest,  c: the compliance

A small compliance changes little, and not in proportion to c, so that a linear score at c = 0 is
blind to the effect and may even ask for a negative compliance. At a large one the friction acts
like a spring, in proportion to 1/c, and from there a fit finds the right compliance, however small.
So where much is left that no score could explain, the effect is fitted to some of the windows from
its largest plausible size, and what this fit explains takes the place of its score:

    fall    1 - V_c/V                            V, V_c: criterion without it and with it
    chance  min(1, exp(-ΔBIC/2))                 ΔBIC = N ln(V/V_c) - ln N, N errors

Where nothing is missing a Bayes factor exceeds k with a chance of 1/k at most (Markov's inequality;
Kass and Raftery 1995 for the factor by BIC).
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.moves import Watch
from identification.discovery.passes import uses
from identification.prediction.fits.model import WindowModel
from identification.prediction.moves.add_effect import add_effect
from identification.prediction.scoring.contenders import is_significant, refit_level
from identification.prediction.scoring.first_fit import Begun, begin, picks, thinned_tangents
from identification.prediction.scoring.scores import WindowScore
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.remaining import is_much_left
from identification.runtime.progress import Progress

GRIP = "grip"  # the state of a joint whose friction gives
MAX_PLACES = 3  # at which it is fitted, those of the best scores


def add_yielding_friction(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with such a friction, where unseen records prove it.

    Args:
        state: after a round in which no other effect was proven.
        progress: is told what is refitted.
    """
    task, watch = state.task, Watch(state.seconds)
    listed = {s.candidate.key: s for s in reversed(state.scores) if _gives(s)}
    best = sorted(listed.values(), key=lambda s: -s.fall)[:MAX_PLACES]
    if not best or not is_much_left(state.model, task.options):
        return state
    level = refit_level(state.scores, task.options)
    is_loud = uses(task.options, "loud_windows")
    tried = (attempt(s.candidate, partial(_from_largest, state.model, s, is_loud)) for s in best)
    found = [s for s in tried if s and _is_felt(s) and is_significant(s, level, task.options)]
    watch.stop("scores")
    state = replace(state, seconds=watch.seconds)
    if not found:
        return state
    keys = {s.candidate.key for s in found}
    rest = [s for s in state.scores if s.candidate.key not in keys]
    scores = sorted([*found, *rest], key=lambda s: -s.fall)
    new = add_effect(replace(state, scores=tuple(scores)), progress)
    is_added = len(new.accepted) > len(state.accepted)
    return new if is_added else replace(new, scores=state.scores)


def _gives(s: WindowScore) -> bool:
    return s.candidate.effect.state == GRIP


def _is_felt(s: WindowScore) -> bool:
    """Returns whether a compliance is larger than what steps of the simulation resolve."""
    sizes = s.candidate.effect.sizes
    return bool(np.any(np.abs(s.size) > np.resize([z.smallest for z in sizes], len(s.size))))


def _from_largest(model: WindowModel, score: WindowScore, is_loud: bool) -> WindowScore:
    """Returns what a fit to some windows explains that begins at the largest plausible size."""
    sizes = score.candidate.effect.sizes
    largest = np.resize([z.largest for z in sizes], len(score.size))
    still = np.zeros_like(score.along)
    begun = begin(model, [replace(score, size=largest, along=still)], is_loud)
    before, errors = _without(model, begun, is_loud)
    fall = 1 - begun.cost / before
    numbers = len(begun.q) - len(model.fit.q)
    gain = -errors * np.log(max(1e-12, 1 - fall)) - numbers * np.log(errors)
    task = begun.task
    q = dict(zip(task.names, begun.q, strict=True))
    along = np.array([q[n] for n in model.fit.problem.names]) - model.fit.q
    values = dict(zip(task.names, task.prior.space.decode(begun.q), strict=True))
    size = np.array([values[n] for n in score.candidate.sizes])
    return replace(score, size=np.resize(size, len(score.size)), along=along, fall=float(fall),
                   p_value=float(min(1.0, np.exp(-gain / 2))))  # fmt: skip


def _without(model: WindowModel, begun: Begun, is_loud: bool) -> tuple[float, int]:
    """Returns V of the windows of a begun fit without its effect, and their number of errors."""
    fit = model.fit
    near = thinned_tangents(fit.tangents, picks(fit.tangents, is_loud=is_loud))
    outputs = begun.task.parts[0].cut.outputs.shape[-1]
    return fit.problem.cost_of(fit.q, [t.r for t in near]), begun.windows * outputs
