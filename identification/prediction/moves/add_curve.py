"""A curve of the data is added where neither a law nor several laws together are proven.

A curve has many numbers and draws what several laws do: the dry friction of a pendulum and the zero
of its encoder are one curve of the rate. Beside it each of them explains little, so that none would
be found afterwards.
"""

from __future__ import annotations

from identification.prediction.moves.add_effect import add_effect
from identification.prediction.task import WindowSearch
from identification.runtime.progress import Progress


def add_curve(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with the best curve that unseen records prove, or what was refitted."""
    return add_effect(state, progress, are_curves=True)
