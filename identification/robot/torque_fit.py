"""The result of a comparison of a robot's torques."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from identification.report.torque_words import size_words
from identification.robot.robot import Robot
from identification.torques.evidence import Evidence
from identification.torques.scores import Score
from identification.written import Files, Written


@dataclass(frozen=True)
class TorqueFit(Written):
    """The result of `fit_torques`.

    Attributes:
        robot: whose logs were compared.
        found: base parameters, fits and scores.
        files_of: returns what writes its files (`identification.written`).
    """

    robot: Robot
    found: Evidence
    files_of: Callable[[TorqueFit], Files]

    def __repr__(self) -> str:
        named = [f"{score.missing.title}: {size_words(score)}" for score in self.named]
        return "; ".join(named) or "torques: no effect is proven"

    @property
    def values(self) -> dict[str, float]:
        """Base parameters and friction by name, in their units."""
        fit = self.found.whole
        return dict(zip(fit.names, fit.fit.θ.tolist(), strict=True))

    @property
    def std(self) -> dict[str, float]:
        """Std of the values by name, in their units."""
        fit = self.found.whole
        return dict(zip(fit.names, fit.fit.std.tolist(), strict=True))

    @property
    def named(self) -> tuple[Score, ...]:
        """The effects that were proven, in the order in which they were found."""
        return self.found.named
