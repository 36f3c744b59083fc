"""The parameters that are sought: those that all records share, and those that each has for itself.

    q = (q_shared, q_own of record 1, q_own of record 2, ...)

The record r feels (q_shared, q_own of r) alone: these are its columns of q.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.estimation.priors import Priors


@dataclass(frozen=True)
class Unknowns:
    """The parameters that are sought, and what is known of them."""

    shared: Priors  # parameters with one value for all records
    own: Priors  # parameters of which each record has a value of its own
    records: tuple[str, ...]  # names of the records

    @property
    def local(self) -> Priors:
        """The parameters that one record feels, by name in the plant."""
        return self.shared.plus(self.own)

    @property
    def all(self) -> Priors:
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
