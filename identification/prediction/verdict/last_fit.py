"""The last fit of a search: its final model, with the steps of the user's model."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.passes import uses
from identification.prediction.judging.extension import as_last_fit
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
    return replace(state, model=final, nominal=final if state.nominal is model else state.nominal)
