"""The last fit of a search, and what it leaves of the effects that were found.

    z² = sᵀ P_ss s       sizes s of an effect; P = C⁻¹, C: covariance of its sizes and free shapes

A search takes longer steps where it can, and the last fit those of the user's model. What the steps
have made is nothing there: the last fit takes away more than half of every size, and what stays is
within its own std. Several sizes that the data trade for one another may each be within its std and
be known together, and a size for a shape: z asks all sizes at once, beside shapes that stay. An
effect with z of less than two is then taken out, and the others are fitted again. One that keeps
its size keeps its name, whatever its std: what is free beside it may do as much, and unseen data
have decided between the two. A curve is judged as a whole by its evidence.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import as_last_fit, refitted
from identification.prediction.task import WindowSearch


def with_last_fit(state: WindowSearch) -> WindowSearch:
    """Returns the state whose final model is fitted as the last one (`as_last_fit`).

    Values that are worse after a fit than before it are kept as they were, and none is fitted.

    Args:
        state: of a search that is over.
    """
    task, model = state.task, state.model
    if state.worse_fit is not None and not model.candidates:
        return state
    is_weighed = bool(model.candidates) and uses(task.options, "priors_of_last_fit")
    last = partial(as_last_fit, model, task.horizon, task.confirm, is_weighed)
    final = attempt(None, last) or model
    nominal = final if state.nominal is model else state.nominal
    return _without_nothing(model, replace(state, model=final, nominal=nominal))


def _without_nothing(before: WindowModel, state: WindowSearch) -> WindowSearch:
    """Returns the state without effects of which the last fit leaves nothing."""
    least = state.task.options.min_proof_t
    gone = [
        a for a in state.accepted
        if is_taken_away(before, state.model, a.candidate)
        and times_std(state.model, a.candidate) < least
    ]  # fmt: skip
    if not gone or not uses(state.task.options, "sizes_of_last_fit"):
        return state
    rest = [a for a in state.accepted if a not in gone]
    kept = [a.candidate for a in rest]
    model = refitted(state.model, kept, state.task.nominal_model, state.task.confirm)
    if model is None:
        return state
    rejected = tuple(replace(a, doubt="size") for a in gone)
    return replace(state, model=model, accepted=tuple(rest), rejected=(*rejected, *state.rejected))


def is_taken_away(before: WindowModel, after: WindowModel, effect: Candidate) -> bool:
    """Returns whether a fit has taken away more than half of every free size of an effect.

    Args:
        before: with the effect.
        after: the same model, fitted again.
        effect: that both have.
    """
    old, new = before.fit.values, after.fit.values
    return all(abs(new[n]) < abs(old[n]) / 2 for n in effect.free if n in old and n in new)


def times_std(model: WindowModel, effect: Candidate) -> float:
    """Returns z of an effect: inf of a curve, of a difference between records, or on a bound.

    Args:
        model: fitted, with the effect.
        effect: that it has.
    """
    names = model.fit.problem.names
    sizes = [names.index(n) for n in effect.free if n in names]
    if effect.effect.is_curve or not sizes or any(names[k] in model.at_bound for k in sizes):
        return np.inf
    own = {effect.effect.parameter(s.name, effect.where) for s in effect.effect.shapes}
    both = [*sizes, *(k for k, n in enumerate(names) if n in own and k not in sizes)]
    slope = model.fit.problem.prior.space.slope(model.fit.q)[both]
    covariance = model.fit.covariance[np.ix_(both, both)] * np.outer(slope, slope)
    precision = np.linalg.pinv(covariance, hermitian=True)
    s, m = np.array([model.fit.values[names[k]] for k in sizes]), len(sizes)
    return float(np.sqrt(max(0.0, s @ precision[:m, :m] @ s)))
