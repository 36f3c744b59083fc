"""The parameters that are sought: those that all records share, and those that each has for itself.

    q = (q_shared, q_own of record 1, q_own of record 2, ...)

The record r feels (q_shared, q_own of r) alone: these are its columns of q.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from identification.model.coordinates import NOTHING, Coordinates


@dataclass(frozen=True)
class Prior:
    """Parameters, and what is known of them before the records speak.

    Attributes:
        space: their coordinates, p of them.
        mean: q̄, shape (p,).
        weight: 1/σ in coordinates, zero where nothing is known, shape (p,).
    """

    space: Coordinates = NOTHING
    mean: np.ndarray = field(default_factory=lambda: np.zeros(0))
    weight: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return self.space.names

    def plus(self, other: Prior) -> Prior:
        """Returns the prior of these parameters, then of others."""
        a, b = self.space, other.space
        space = Coordinates(
            (*a.names, *b.names), np.concatenate([a.logarithmic, b.logarithmic]).astype(bool),
            np.concatenate([a.lower, b.lower]), np.concatenate([a.upper, b.upper]),
            np.concatenate([a.scale, b.scale]),
        )  # fmt: skip
        mean, weight = (np.concatenate([getattr(self, f), getattr(other, f)])
                        for f in ("mean", "weight"))  # fmt: skip
        return Prior(space, mean, weight)

    def taken(self, places: np.ndarray, names: Sequence[str] | None = None) -> Prior:
        """Returns the prior of some of the entries, under other names where they are given."""
        s, at = self.space, np.asarray(places, int)
        names = [s.names[k] for k in at] if names is None else names
        space = Coordinates(tuple(names), s.logarithmic[at], s.lower[at], s.upper[at], s.scale[at])
        return Prior(space, self.mean[at], self.weight[at])

    def only(self, names: Sequence[str]) -> Prior:
        """Returns the prior of the parameters that have one of these names."""
        return self.taken(np.array([k for k, n in enumerate(self.names) if n in names], int))


@dataclass(frozen=True)
class Unknowns:
    """The parameters that are sought, and what is known of them.

    Attributes:
        shared: parameters with one value for all records.
        own: parameters of which each record has a value of its own.
        records: names of the records.
    """

    shared: Prior
    own: Prior
    records: tuple[str, ...]

    @property
    def local(self) -> Prior:
        """The parameters that one record feels, by name in the plant."""
        return self.shared.plus(self.own)

    @property
    def all(self) -> Prior:
        """All of them in the order of q; a record's own ones are called `name [record]`."""
        m = len(self.own.names)
        own = self.own.taken(
            np.tile(np.arange(m), len(self.records)),
            [f"{n} [{r}]" for r in self.records for n in self.own.names],
        )
        return self.shared.plus(own)

    def columns(self, record: int) -> np.ndarray:
        """Returns the entries of q that a record feels, in the order of `local`."""
        p, m = len(self.shared.names), len(self.own.names)
        return np.concatenate([np.arange(p), p + m * record + np.arange(m)]).astype(int)
