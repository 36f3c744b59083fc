"""What a fitted model tells of itself, whichever search has fitted it.

`identification.kalman.refit.Refit` is a model that was fitted along a free run, and
`identification.prediction.fits.model.WindowModel` one that was fitted to windows of records.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from identification.estimation.uncertainty import mostly_steps, share_left
from identification.model.predictor import Plant

# Of the error of the fitted windows: below it a fifth of the mean square comes from the steps, and
# is nothing that is missing.
TOLD_ERROR = 0.9
BOUND_TOLERANCE = 1e-6  # relative: a value this near to a bound lies on it


@dataclass(frozen=True)
class StepShift:
    """The change of a fit with a quarter of the model's step, to first order."""

    # change of each value, shape (p,), in their units; zero where the windows do not feel a value,
    # NaN where they cannot be simulated with finer steps
    values: np.ndarray
    error: float  # rms error of the fitted windows then, over what it is now; NaN likewise

    @property
    def is_known(self) -> bool:
        """Tells whether the windows could be simulated with finer steps."""
        return bool(np.isfinite(self.error) or np.isfinite(self.values).any())

    def far(self, std: Mapping[str, float]) -> list[str]:
        """Returns the values whose std is mostly the error of the steps, the worst first.

        Args:
            std: by name, in the values' units, with the error of the steps; NaN where not known.
        """
        return mostly_steps(self.values, std)

    @property
    def left(self) -> float:
        """The share of the rms error that finer steps would leave: 1 where all of it."""
        return share_left(self.error)

    def is_lower(self) -> bool:
        """Returns whether finer steps would lower the error by so much that it is told."""
        return self.error < TOLD_ERROR


class Fitted(Protocol):
    """A fitted model, as a report reads it."""

    @property
    def plant(self) -> Plant:
        """The plant with its own values."""

    @property
    def values(self) -> Mapping[str, float]:
        """Values of all parameters that are not the plant's own, by name, in their units."""

    @property
    def own_values(self) -> Mapping[str, Mapping[str, float]]:
        """Values that each record has for itself, by record and by name; empty without such."""

    @property
    def told_values(self) -> Mapping[str, float]:
        """`values`, and those of single records as `name [record]`."""

    @property
    def told_std(self) -> Mapping[str, float]:
        """Std of the free values by name, in their units, with the error of the model's steps.

        NaN where it is not known or a bound holds the value, inf where no data feel it.
        """

    @property
    def at_bound(self) -> tuple[str, ...]:
        """Names of the free values that lie on a bound of the search."""

    @property
    def unlearned(self) -> Mapping[str, float]:
        """Std of each free value over the std that was known before; 0 where none was."""

    @property
    def departures(self) -> Mapping[str, float]:
        """Change of each free value since before the fit, in std of what was known; 0 without."""

    @property
    def finer(self) -> StepShift | None:
        """The change of the fit with a quarter of the model's step; None where nobody asks."""
