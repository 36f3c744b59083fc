"""The results of what is done with a robot: a fit, a comparison of torques, the next experiment."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from identification.estimation.fit import Fit
from identification.logs.log import Log
from identification.model.rollout import State
from identification.prediction.records_fit import RecordsFit
from identification.quantities import quantity
from identification.report.torques.tables import size_words
from identification.robot.results.record_error import AS_WRITTEN, FITTED, Confirmation, of_record
from identification.robot.robot import Robot
from identification.storage.written import Files, Written

if TYPE_CHECKING:  # slow to import
    from identification.experiment.design import Design
    from identification.torques.evidence import Evidence
    from identification.torques.scores import Score


@dataclass(frozen=True)
class RobotFit(Written):
    """The result of `fit`.

    Attributes:
        robot: the robot that was fitted.
        found: a fit of a free run, or of windows of one or several records.
        files_of: returns what writes its files (`identification.storage.written`).
    """

    robot: Robot
    found: Fit | RecordsFit
    files_of: Callable[[RobotFit], Files]

    def __repr__(self) -> str:
        parameters = self.robot.plant.parameters
        units = {n: parameters[n.partition(" [")[0]].unit for n in self.values}
        return ", ".join(
            f"{n} = {quantity(v, self.std[n], units[n])}" + ", on its bound" * self.at_bound[n]
            for n, v in self.values.items()
        )

    @property
    def values(self) -> dict[str, float]:
        """The fitted values by name, in their units; a record's own ones are `name [record]`."""
        return self.found.values

    @property
    def shared(self) -> dict[str, float]:
        """The fitted values that hold for all records."""
        return self.found.shared

    @property
    def own_values(self) -> dict[str, dict[str, float]]:
        """The values that each record has for itself, by record and by name, in their units."""
        return self.found.own_values

    @property
    def std(self) -> dict[str, float]:
        """Std of the values by name, in their units; inf where a free run does not tell them."""
        return dict(zip(self.values, self.found.std.tolist(), strict=True))

    @property
    def start(self) -> dict[str, float]:
        """The values with which the fit began, by name, in their units."""
        return dict(zip(self.values, map(float, self.found.start), strict=True))

    @property
    def at_bound(self) -> dict[str, bool]:
        """True where a value lies on a bound, by name."""
        return dict(zip(self.values, map(bool, self.found.at_bound), strict=True))

    @property
    def converged(self) -> bool:
        """Returns whether the search ended by itself."""
        return self.found.converged

    @property
    def stopped(self) -> bool:
        """Returns whether the user stopped the search of a free run; its best values are kept."""
        return self.found.stopped

    @property
    def is_worse(self) -> bool:
        """Returns whether it predicts unseen records worse than the values with which it began.

        Such values are not to be used. Only a fit over a horizon is compared in this way.
        """
        return self.found.worse is not None

    @property
    def begun(self) -> State | None:
        """The initial state of a free run that was estimated with the values; None over windows."""
        if not isinstance(self.found, Fit):
            return None
        estimate = self.found.estimate
        return estimate.predictor.settings(estimate.space.decode(estimate.q))[0].rows(0)

    @property
    def unseen(self) -> tuple[Confirmation, ...]:
        """The values of the robot's file and the fitted ones on what the fit has not seen.

        One comparison for each record over the horizon; none for a free run, whose `found` has the
        error on the part that was not fitted.
        """
        if self.found.horizon is None:
            return ()
        return tuple(
            of_record(e, self.found.unit, (AS_WRITTEN, FITTED))
            for e in self.found.errors
            if e.role == "confirm"
        )


@dataclass(frozen=True)
class TorqueFit(Written):
    """The result of `fit_torques`.

    Attributes:
        robot: whose logs were compared.
        found: base parameters, fits and scores.
        files_of: returns what writes its files (`identification.storage.written`).
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


@dataclass(frozen=True)
class NextExperiment(Written):
    """The result of `design_experiment`.

    Attributes:
        robot: whose next experiment it is, with what was found.
        found: the design: the experiment, its limits, and what it is expected to tell.
        files_of: returns what writes its files (`identification.storage.written`).
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
