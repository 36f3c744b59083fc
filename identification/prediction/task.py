"""What a search over a horizon is asked, and what it knows after a step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.moves import SearchState, Task, Watch
from identification.effects.effect import Candidate
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.trial import Contender
from identification.prediction.scoring.screening import score_all
from identification.runtime.progress import Progress
from identification.windows.records import Record
from identification.windows.unseen import Unseen


@dataclass(frozen=True, kw_only=True)
class RecordsTask(Task):
    """The question what a model lacks to explain several records."""

    records: tuple[Record, ...]  # to fit and to confirm
    # what another evidence has found missing: it is refitted whatever its score over windows is
    suggested: tuple[Candidate, ...] = ()

    @property
    def horizon(self) -> float:
        """The time over which records are predicted [s]."""
        return float(self.nominal_model.horizon or 0.0)

    @property
    def confirm(self) -> list[Record]:
        """Records that no fit may see."""
        return [r for r in self.records if r.role == "confirm"]


@dataclass(frozen=True, kw_only=True)
class WindowSearch(SearchState):
    """A search by predictions over a horizon; its effects are `Contender`s."""

    accepted: tuple[Contender, ...]
    # errors of the values with which the fit began, on the records that confirm; over the horizon
    # alone where that refutes them
    begun: Unseen
    # errors of the fitted values on the records that confirm, where they are worse than those of
    # the values with which the fit began: the search then begins with the latter. None where they
    # are not.
    worse_fit: Unseen | None = None
    # the model with the roles of the records exchanged; None where it was not needed
    exchanged: WindowModel | None = None

    @property
    def room(self) -> int:
        """Returns how many effects more may be named."""
        options = self.task.options
        names = [a for a in self.accepted if not a.candidate.effect.is_of_records]
        return int(min(options.max_effects, options.max_horizon_effects)) - len(names)


# The model of a move that finishes a search, its effects, and those that it lost, which are in
# doubt.
Change = tuple[WindowModel, tuple[Contender, ...], tuple[Contender, ...]]


def finishing(
    change: Callable[[WindowSearch, Progress], Change],
) -> Callable[[WindowSearch, Progress], WindowSearch]:
    """Returns the move that makes a change; what it loses comes before what was lost earlier.

    Args:
        change: returns the change of a state, and tells what it does.
    """

    def make(state: WindowSearch, progress: Progress) -> WindowSearch:
        watch = Watch(state.seconds)
        model, accepted, lost = change(state, progress)
        watch.stop("refits")
        scores = state.scores
        if model is not state.model:  # what is left beside the new model is asked of it
            again = partial(score_all, model, state.task.effects, state.task.options)
            scores = attempt(None, again) or scores
            watch.stop("scores")
        return replace(
            state, model=model, accepted=accepted, rejected=(*lost, *state.rejected),
            scores=scores, seconds=watch.seconds,
        )  # fmt: skip

    return make
