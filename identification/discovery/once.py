"""Refits of one effect at one place that end at the same values are one refit.

A candidate is refitted from several sizes, of which the nearest to the data is not known before.
Two of these searches often end in one minimum. They differ by what is left when a search stops,
which is little beside the std.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isclose, isfinite
from typing import Protocol, TypeVar

from identification.effects.effect import Candidate

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
