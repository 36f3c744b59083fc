"""The linear system of a plant and of the unlogged errors of its inputs, with the state z = (x, w).

    x_{k+1} = A_k x_k + B_k w_k,    w_{k+1} = a_k w_k + (1 - a_k²)^½ ρ ν_k,    y_k = C x_k

x_0 is zero and w_0 has the std ρ. Where another record begins, A, B and a are zero: nothing is
known of its inputs' error.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np


@dataclass(frozen=True, eq=False)
class System:
    """The system over the N samples of a log; all its arrays are contiguous doubles."""

    A: np.ndarray  # transition of the plant's state, shape (N-1, nx, nx)
    B: np.ndarray  # effect of an input's error, shape (N-1, nx, nu)
    C: np.ndarray  # outputs from the plant's state, shape (ny, nx)
    a: np.ndarray  # share of an error that is left after a sample, shape (N-1,)
    variances: np.ndarray  # ρ² of each input, in units of σ², shape (nu,)

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Numbers of the plant's states, of the inputs and of the outputs."""
        return self.A.shape[1], self.B.shape[2], len(self.C)

    @cached_property
    def records(self) -> tuple[tuple[int, int], ...]:
        """First sample of each record, and of the next: nothing passes from one to the next."""
        begins = 1 + np.flatnonzero(self.a == 0)
        return tuple(pairwise([0, *begins.tolist(), len(self.a) + 1]))

    @property
    def fresh(self) -> np.ndarray:
        """The variance over σ² of what is new in each input's error, by sample, shape (N, nu)."""
        return np.concatenate([[1.0], 1 - self.a**2])[:, None] * self.variances

    def with_outputs(self, C: np.ndarray) -> System:
        """Returns the same system with other outputs, such as those of scaled sensors."""
        return System(self.A, self.B, np.ascontiguousarray(C, float), self.a, self.variances)
