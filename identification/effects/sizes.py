"""The numbers of an effect: sizes, zero where it is absent, shapes, and the time when it begins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

Sign = Literal[-1, 0, 1]
FARTHEST = 5.0  # of the largest plausible size


@dataclass(frozen=True)
class Size:
    """The size of an effect; zero means that it is absent.

    Attributes:
        name: as in the law and in JSON.
        unit: SI unit, "" when dimensionless.
        largest: the largest plausible magnitude [unit].
        probe: the magnitude at which its sensitivity is taken [unit].
        sign: 1 or -1 where physics admits only that sign, else 0.
        about: what it is, in words.
        smallest: below, it is no more than an error of the simulation's steps: no proof [unit].
        present: the value it has when the effect is there, where it can have but one: then its
            shapes are what is estimated.
    """

    name: str
    unit: str
    largest: float
    probe: float
    sign: Sign = 0
    about: str = ""
    present: float | None = None
    smallest: float = 0.0

    @property
    def farthest(self) -> float:
        """The bound of a search, beyond which a size is not believed [unit]."""
        return FARTHEST * self.largest


@dataclass(frozen=True)
class Shape:
    """A shape parameter of an effect; without meaning while its sizes are zero.

    Attributes:
        name: as in the law and in JSON.
        unit: SI unit, "" when dimensionless.
        grid: values to try before it is freed [unit].
        lower: smallest admissible value [unit].
        upper: largest admissible value [unit].
        free: whether it is estimated once the effect is named; False for an integer.
        about: what it is, in words.
        usual: the value where nothing is said; the grid's middle when None.
        step: how far apart values are tried beside the best of the grid, where the likelihood has
            so many maxima that a refit does not find the way; 0 where it does [unit].
        of_log: whether it tells something of one log and nothing of the robot, so that it is kept
            for no other log.
        words: what the values 0, 1, ... mean, where it is a choice and no number.
    """

    name: str
    unit: str
    grid: tuple[float, ...]
    lower: float
    upper: float
    free: bool = True
    about: str = ""
    usual: float | None = None
    step: float = 0.0
    of_log: bool = False
    words: tuple[str, ...] = ()

    @property
    def at_first(self) -> float:
        """Its value in a model that does not have the effect: the usual one, or one of the grid."""
        return self.grid[len(self.grid) // 2] if self.usual is None else self.usual


@dataclass(frozen=True)
class Onset:
    """The beginning of an effect: a factor of all that it adds, from 0 to 1 about a time.

        c(t) = clip(½ + (t - t_s)/w, 0, 1)

    An effect with an onset is one law behind a course in time, so its law is evaluated once for
    all times at which it may begin.
    """

    shape: str  # name of the shape that is t_s, a time of the record [s]
    lasts: float  # w [s]

    def course(self, time: np.ndarray, begins: float) -> np.ndarray:
        """Returns the factor at some times [s], where the effect begins at `begins` [s]."""
        return np.clip(0.5 + (time - begins) / self.lasts, 0.0, 1.0)
