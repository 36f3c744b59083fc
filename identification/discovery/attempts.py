"""The place through which both searches evaluate what they try: a failure of it ends no search.

A candidate may diverge where a refit takes its size or its shape, may be refused at a value that
nobody gave (motors with more inertia than the robot), or make a matrix that cannot be solved. It is
then rejected and told, and the search goes on. Only the nominal model may end a search. No other
function of the search or of its evidences catches these errors, so that what is evaluated elsewhere
is seen to be unguarded; a test holds this.

Two refits of one effect that end at the same values are one: a candidate is refitted from several
sizes, of which the nearest to the data is not known before, and two of these searches often end in
one minimum.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from math import isclose, isfinite
from typing import Protocol, TypeVar

import numpy as np

from identification.effects.effect import Candidate
from identification.errors import DivergenceError, InputError
from identification.runtime.pool import each_part
from identification.runtime.progress import Progress

SAME_STDS = 0.1  # of the std: values are told to two digits of it
SAME_RELATIVE = 1e-3  # of values whose std is not known


class Refitted(Protocol):
    """An effect that was refitted, as `listed_once` takes it."""

    @property
    def candidate(self) -> Candidate:
        """The effect at its place."""

    @property
    def parameters(self) -> Mapping[str, tuple[float, float, str]]:
        """Value, std and unit by symbol."""


R = TypeVar("R", bound=Refitted)


def listed_once(refitted: Sequence[R]) -> tuple[R, ...]:
    """Returns the refits without those that end at the values of one before them.

    Args:
        refitted: effects, the best first.
    """
    kept: list[R] = []
    for each in refitted:
        if not any(_is_same(each, other) for other in kept):
            kept.append(each)
    return tuple(kept)


def _is_same(a: Refitted, b: Refitted) -> bool:
    """Returns whether two refits are of one effect at one place, with the same values."""
    if a.candidate.key != b.candidate.key or a.parameters.keys() != b.parameters.keys():
        return False
    pairs = ((a.parameters[name], b.parameters[name]) for name in a.parameters)
    return all(
        isclose(x, y, rel_tol=SAME_RELATIVE, abs_tol=SAME_STDS * std if isfinite(std) else 0.0)
        for (x, std, _), (y, _, _) in pairs
    )


FAILURES = (InputError, np.linalg.LinAlgError, ArithmeticError)
NOT_FINITE = "its simulation leaves the finite numbers"
T = TypeVar("T")


@dataclass(frozen=True)
class Failed:
    """Something that a search tried and that could not be evaluated."""

    name: str  # of the effect; what the search was about to do, where that is no candidate
    where: str  # its place, in words; "" where it has none
    # whether a simulation diverged; else the values that were tried were refused, or equations
    # could not be solved
    diverged: bool
    reason: str  # what the error said; "" where it said nothing
    dropped: bool = False  # whether it could be evaluated, and the search left it for that reason

    @property
    def key(self) -> tuple[str, str]:
        """The effect and its place."""
        return self.name, self.where

    @property
    def outcome(self) -> str:
        """The outcome, in words."""
        if self.dropped:
            return f"begun and left, because {self.reason}"
        what = "its simulation diverged" if self.diverged else "it could not be evaluated"
        return f"tried, and {what}" + (f": {self.reason}" if self.reason else "")

    def __str__(self) -> str:
        return f"{', '.join(filter(None, self.key))}: {self.outcome}"


_NOTE: ContextVar[Callable[[Failed], None] | None] = ContextVar("failed", default=None)


@contextmanager
def collected(progress: Progress, before: Sequence[Failed] = ()) -> Iterator[list[Failed]]:
    """Yields what fails in the block, each effect at each place once, after what failed before.

    Args:
        progress: is told a line for each.
        before: what has failed until now.
    """
    failed = [*before]

    def note(one: Failed) -> None:
        if one.key not in {f.key for f in failed}:
            failed.append(one)
            progress(str(one))

    token = _NOTE.set(note)
    try:
        yield failed
    finally:
        _NOTE.reset(token)


def attempt(tried: Candidate | str | None, evaluate: Callable[[], T]) -> T | None:
    """Returns what an evaluation returns; None where it fails, which is told.

    Args:
        tried: the candidate, or what the search is about to do; None where a failure is not told,
            because something else takes its place.
        evaluate: the evaluation.
    """
    try:
        return evaluate()
    except FAILURES as error:
        # What stands behind a semicolon tells a user what to give, who gave nothing here.
        reason = str(error).partition(";")[0]
        if tried is not None:
            _tell(tried, isinstance(error, DivergenceError), reason)
        return None


def attempt_each(
    tasks: Sequence[tuple[Candidate | str | None, Callable[[], T]]],
) -> Iterator[T | None]:
    """Yields what several evaluations return, as `attempt` does; they run side by side.

    Args:
        tasks: what is tried, and its evaluation, each; failures are told in this order.
    """

    def part(task: tuple[Candidate | str | None, Callable[[], T]]) -> tuple[T | None, list[Failed]]:
        failed: list[Failed] = []
        token = _NOTE.set(failed.append)
        try:
            return attempt(*task), failed
        finally:
            _NOTE.reset(token)

    for found, failed in each_part(part, tasks):
        note = _NOTE.get()
        if note is not None:
            for one in failed:
                note(one)
        yield found


def tell_lost(asked: Iterable[Candidate], found: Iterable[Candidate]) -> None:
    """Tell of the candidates of which no shape could be evaluated.

    Args:
        asked: what was to be evaluated.
        found: what was.
    """
    keys = {c.key for c in found}
    for candidate in asked:
        if candidate.key not in keys:
            _tell(candidate, True, "")


def tell_dropped(candidate: Candidate, reason: str) -> None:
    """Tell of a candidate that was begun and left, and why, so that no one misses it.

    Args:
        candidate: which.
        reason: why, as a clause behind "because".
    """
    _tell(candidate, False, reason, dropped=True)


def refuse_infinite(*numbers: float | np.ndarray) -> None:
    """Refuse the numbers of an evaluation that are not finite.

    Raises:
        DivergenceError: one of them is not.
    """
    if not all(np.isfinite(x).all() for x in numbers):
        raise DivergenceError(NOT_FINITE)


def _tell(tried: Candidate | str, diverged: bool, reason: str, dropped: bool = False) -> None:
    note = _NOTE.get()
    if note is not None:
        name, where = (tried, "") if isinstance(tried, str) else tried.key
        note(Failed(name, where, diverged, reason, dropped))
