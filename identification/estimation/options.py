"""Options of a search, and the words for how it ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from identification.errors import InputError

HORIZONS = (0.05, 0.2, 0.5, 1.0)  # of the log: a short one keeps a search from local minima
Progress = Callable[[str], None]
Status = Literal["converged", "iterations", "stopped"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of a search.

    Attributes:
        method: the `method` of `scipy.optimize.least_squares`; "lm" has no bounds.
        criterion: "trace" (least squares) or "det" (maximum likelihood, covariance estimated).
        loss: robust loss of `least_squares`: "linear", "soft_l1", "huber", "cauchy", "arctan".
        horizons: growing fractions of the log, of which the last is 1; (1.0,) is a single fit of
            the free run over the whole log.
        tolerance: relative change of cost and of q at which a search stops.
        max_evaluations: largest number of simulations of the outputs for each horizon.
        relative_noise: std of a sample's noise divided by the sample, where the noise grows with
            the signal. Each residual is then divided by this std, computed from the prediction.
        priors: std of the prior of q about the start, by name (of ln(value) where q is a
            logarithm).

    Raises:
        InputError: the horizons do not grow to 1, or a prior's std is not positive.
    """

    method: Literal["trf", "lm", "dogbox"] = "trf"
    criterion: Literal["trace", "det"] = "trace"
    loss: str = "linear"
    horizons: tuple[float, ...] = HORIZONS
    tolerance: float = 1e-8
    max_evaluations: int = 60
    relative_noise: float = 0.0
    priors: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        h = self.horizons
        if not h or not h[0] > 0 or h[-1] != 1 or not all(np.diff(h) > 0):
            raise InputError(f"horizons {h} must grow to 1, such as {HORIZONS}")
        if self.method == "lm" and self.loss != "linear":
            raise InputError(
                f"method 'lm' knows no robust loss; leave out {self.loss!r}, or search by 'trf'"
            )
        for name, std in self.priors.items():
            if not std > 0:
                raise InputError(f"the prior of {name} has std {std:g}; give a positive one")
