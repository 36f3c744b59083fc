"""The last fit of a search, and what it leaves of the effects that were found.

    z² = sᵀ P_ss s       sizes s of an effect; P = C⁻¹, C: covariance of its sizes and free shapes

A search takes longer steps where it can, and the last fit those of the user's model. What the steps
have made is nothing there: its size is within its own std. Several sizes that the data trade for
one another may each be within its std and be known together, and a size for a shape, so that z asks
all sizes at once, beside shapes that stay. An effect with z of less than two is taken out, and the
others are fitted again. A curve is judged as a whole by its evidence, which pays for every node.
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
    return _without_nothing(replace(state, model=final, nominal=nominal))


def _without_nothing(state: WindowSearch) -> WindowSearch:
    """Returns the state without effects of which the last fit leaves nothing."""
    if not uses(state.task.options, "sizes_of_last_fit"):
        return state
    least = state.task.options.min_proof_t
    gone = [a for a in state.accepted if times_std(state.model, a.candidate) < least]
    if not gone:
        return state
    rest = [a for a in state.accepted if a not in gone]
    kept = [a.candidate for a in rest]
    model = refitted(state.model, kept, state.task.nominal_model, state.task.confirm)
    if model is None:
        return state
    rejected = tuple(replace(a, doubt="size") for a in gone)
    return replace(state, model=model, accepted=tuple(rest), rejected=(*rejected, *state.rejected))


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
