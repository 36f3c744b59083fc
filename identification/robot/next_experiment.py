"""The result of a design of the next experiment of a robot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from identification.experiment.design import Design
from identification.logs.log import Log
from identification.robot.robot import Robot
from identification.written import Files, Written


@dataclass(frozen=True)
class NextExperiment(Written):
    """The result of `design_experiment`.

    Attributes:
        robot: whose next experiment it is, with what was found.
        found: the design: the experiment, its limits, and what it is expected to tell.
        files_of: returns what writes its files (`identification.written`).
    """

    robot: Robot
    found: Design
    files_of: Callable[[NextExperiment], Files]

    def __repr__(self) -> str:
        return f"next experiment of {self.robot.file.path.name}, {self.log.duration:g} s"

    @property
    def log(self) -> Log:
        """The inputs to play, and the outputs that the model expects: nothing was measured."""
        return self.found.best.played.log

    @property
    def before(self) -> dict[str, float]:
        """Std of the free values by name before the experiment, in their units."""
        return dict(zip(self.found.hypotheses[0].names, self.found.before.tolist(), strict=True))

    @property
    def after(self) -> dict[str, float]:
        """Expected std of the free values by name after it, in their units."""
        return dict(zip(self.found.hypotheses[0].names, self.found.best.std.tolist(), strict=True))
