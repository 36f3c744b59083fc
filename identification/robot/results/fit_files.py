"""The files of a fit of a robot: result.json with its verdict in sentences, robot.toml, the report.

Those of a comparison of torques, whose values are a start of a fit and no model, lack robot.toml.

A fit that is proven to predict unseen records worse is told otherwise, and its values are not to be
used. One that is worse and not proven to be is still no better, and a reader should not have to
find that out from two numbers. So is one that predicts the outputs of one unit worse: a fit may
give up the angles to win the slides, which one number over all outputs hides.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from identification.estimation.metrics import fit_percent
from identification.logs.log import Log
from identification.model.predictor import Predictor
from identification.prediction.records_fit import RecordsFit
from identification.quantities import plain, plain_unit, quantity
from identification.refusals.far_angles import far_sentence
from identification.report.fit.headline import fit_headline
from identification.report.fit.json import fit_to_json
from identification.report.fit.verdict import answer_sentence
from identification.report.page.figures import compare_figure, windows_figure
from identification.report.page.page import Section, Table, write_report
from identification.report.page.page_files import PageFiles
from identification.report.torques.report import evidence_to_json, torque_headline, torque_sections
from identification.report.torques.words import torque_verdict
from identification.report.words.errors import kind, listed
from identification.report.words.values import departure_sentences, value_words
from identification.robot.free_swing import impossible_sentence
from identification.robot.reading import doubtful
from identification.robot.results.confirmation import confirm, plant_with
from identification.robot.results.mjcf import write_mjcf
from identification.robot.results.record_error import (
    AS_WRITTEN,
    FITTED,
    Confirmation,
    Repetition,
    Rest,
    find_repetitions,
    find_rests,
)
from identification.robot.results.results import RobotFit, TorqueFit
from identification.robot.results.unexplained import find_unexplained
from identification.robot.results.write import write_robot
from identification.shares import change

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEAST = 0.01  # rise of the mean square that is told; the noise of a right fit makes less
LEAST_OF_UNIT = 0.1  # rise of the mean square of one unit that is told
FARTHEST = 100.0  # a value that changes by this factor is not believed


def robot_fit_to_json(result: RobotFit, confirmed: Sequence[Confirmation] = ()) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; unknown and infinite numbers are null."""
    found = result.found
    record = {"horizon": None, "worse": None, **fit_to_json(found)}
    weak: list[Rest | Repetition] = [*find_rests(result.robot), *find_repetitions(result.robot)]
    unexplained = () if result.stopped else find_unexplained(result.robot, result)
    said = (*(confirmed or result.unseen), *weak)
    far = _far(record["parameters"])
    # Then nothing else of the verdict matters as much.
    first = int(result.is_worse or result.stopped)
    worse = no_better(result, confirmed or result.unseen)
    far = [*doubtful(result.robot), *worse, *far]
    if not first:
        departures = departure_sentences(found.model) if isinstance(found, RecordsFit) else []
        far = [answer_sentence(found, not worse), *map(str, unexplained), *departures, *far]
    if no_body := impossible_sentence(result.robot, result.shared):
        far.append(no_body)
    verdict = [*record["verdict"][:first], *far, *record["verdict"][first:], *map(str, said)]
    return {
        **record, "confirm": plain(tuple(confirmed)), "verdict": verdict,
        "findings": [*(u.finding for u in unexplained), *(r.finding for r in weak)],
        "remarks": list(result.robot.remarks),
    }  # fmt: skip


def no_better(result: RobotFit, confirmed: Sequence[Confirmation]) -> list[str]:
    """Returns a sentence where the fitted values predict worse and this is not proven, or none."""
    if result.is_worse or result.stopped or not confirmed:
        return []
    if result.found.horizon is not None:
        before, after = result.found.unseen_rms
    else:
        before, after = np.sqrt(np.mean([(c.before**2, c.after**2) for c in confirmed], axis=0))
    rise = (after / before) ** 2 - 1 if before > 0 else 0.0
    if not rise > LEAST:
        return worse_unit(confirmed)
    return [
        "The fitted values predict unseen data worse than the values with which the fit"
        f" began (mean square {change(rise)}). This may be chance, but it does not confirm"
        " the fitted values: fit a longer log, or more logs, before you use them.",
        *worse_unit(confirmed),
    ]


def worse_unit(confirmed: Sequence[Confirmation]) -> list[str]:
    """Returns one sentence that names outputs that are predicted worse while others are not."""
    rises = _rises(confirmed)
    worse = {unit: rise for unit, rise in rises.items() if rise > LEAST_OF_UNIT}
    others = {unit: rise for unit, rise in rises.items() if unit not in worse}
    if not worse or not others:
        return []
    return [
        f"The fitted values predict {_told(worse)} of the unseen data worse than the values with"
        f" which the fit began, but not {_told(others)}. This may be chance, or the fit improves"
        " one at the cost of the other: fit a longer log, or more logs, before you rely on"
        f" what it predicts of {listed([kind(unit) for unit in worse])}."
    ]


def _rises(confirmed: Sequence[Confirmation]) -> dict[str, float]:
    """Returns the rise of the mean square by unit, over records, each of which counts alike."""
    rises = {}
    for unit in dict.fromkeys(unit for c in confirmed for unit in c.before_by_unit):
        before = sum(c.before_by_unit.get(unit, 0.0) ** 2 for c in confirmed)
        after = sum(c.after_by_unit.get(unit, 0.0) ** 2 for c in confirmed)
        if before > 0:
            rises[unit] = after / before - 1
    return rises


def _told(rises: Mapping[str, float]) -> str:
    """Returns the outputs with the change of their mean square, in words."""
    return listed([f"the {kind(u)} (mean square {change(r)})" for u, r in rises.items()])


def _far(parameters: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Returns a sentence about values that changed by a factor that no robot explains."""
    far = [
        n for n, p in parameters.items()
        if p["initial"] and not 1 / FARTHEST < abs(p["value"] / p["initial"]) < FARTHEST
        and p["initial"] * p["value"] > 0
    ]  # fmt: skip
    if not far:
        return []
    return [
        f"{', '.join(far)}: more than {FARTHEST:g} times from where the fit began; the log's units"
        " and signs must be those of the model (rad or m, s, and what its actuators take)."
    ]


@dataclass(frozen=True)
class RobotFitFiles(PageFiles):
    """The files of a fit of a robot."""

    fitted: RobotFit  # the result of the fit

    @cached_property
    def record(self) -> dict[str, Any]:
        """The fit as plain values, with how it predicts what it has not seen."""
        return robot_fit_to_json(self.fitted, self.confirmed)

    @cached_property
    def confirmed(self) -> Sequence[Confirmation]:
        """How it predicts each record that it has not seen, or the unseen part of each log."""
        return confirm(self.fitted.robot, self.fitted)

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figure is drawn once."""
        return [_values_section(self.fitted), _error_section(self.fitted)]

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write robot.toml and model.xml: the robot with the fitted values, read from `place`."""
        found = self.fitted
        remark = self.record["verdict"][0] if found.is_worse or found.stopped else ""
        path = folder / "robot.toml"
        std = None if remark else found.std  # such values are not to be relied on
        write_robot(found.robot, found.shared, path, place, remark, found.own_values, std)
        write_mjcf(found.robot, found.shared, folder / "model.xml", place, remark)
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        robot, found = self.fitted.robot, self.fitted
        logs = [log.name for log in (robot.log, *robot.others)]
        units = {p.name: plain_unit(p.unit) for p in robot.plant.parameters}
        worse = no_better(found, self.confirmed or found.unseen)
        return write_report(
            path,
            f"{', '.join(logs)}: fitted",
            self.record["verdict"],
            self.sections,
            good=False if found.is_worse else None,
            data=[*logs, *(log.name for log in robot.records)],
            headline=fit_headline(found.found, units, not worse),
        )


@dataclass(frozen=True)
class TorqueFiles(PageFiles):
    """The files of a comparison of torques."""

    fitted: TorqueFit  # the result

    @cached_property
    def record(self) -> dict[str, Any]:
        """The comparison as plain values."""
        robot = self.fitted.robot
        model, column = robot.plant.model, robot.file.columns
        logs = (robot.log, *robot.others, *robot.records)
        # Forces do not tell the unit of a motion that needs next to none, such as a slow one.
        far = [f"{said}." for log in logs if (said := far_sentence(model, log, column))]
        return {"verdict": [*torque_verdict(self.fitted.found, model), *far[:1]],
                **evidence_to_json(self.fitted.found, model),
                "remarks": list(robot.remarks)}  # fmt: skip

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""
        return torque_sections(self.fitted.found, self.fitted.robot.plant.model)

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        names = [rows.name for rows in self.fitted.found.equations.rows]
        title = f"{', '.join(names)}: torques"
        headline = torque_headline(self.fitted.found, self.fitted.robot.plant.model)
        return write_report(
            path, title, self.record["verdict"], self.sections, data=names, headline=headline
        )


def _values_section(found: RobotFit) -> Section:
    """Returns the section on the fitted values, beside those with which the fit began."""
    units = {p.name: plain_unit(p.unit) for p in found.robot.plant.parameters}
    rows, words_of = [], value_words(found.values, found.robot.plant)
    for name, value in found.values.items():
        unit, first = units[name.partition(" [")[0]], found.start[name]
        bound = ", on its bound" if found.at_bound[name] else ""
        words = quantity(value, found.std[name], unit, like=first)
        begun = quantity(first, unit=unit, like=value)
        called = words_of.get(name, name) if " [" in name else name  # else as in robot.toml
        rows.append((called, begun, f"{words}{bound}"))
    text = "A value has the digits of its std. A value on its bound has no std."
    return Section("The parameters", text, table=Table(("parameter", "begun", "fitted"), (*rows,)))


def _error_section(found: RobotFit) -> Section:
    """Returns the section on what both models predict of a record that the fit has not seen."""
    log, horizon = _shown(found), found.found.horizon
    if horizon is None:
        title = f"Measured and simulated, {log.name}"
        text = "A free run from the inputs alone, with the fitted values."
        return Section(title, text, figures=((title, _free_run(found, log)),))
    title = f"Measured and predicted over {horizon:g} s, {log.name}"
    text = f"The first output, {AS_WRITTEN} and {FITTED}, from each window's best state."
    values = _values(found, log)
    models = {AS_WRITTEN: _given(found, log), FITTED: values}
    plant = plant_with(found.robot, log, values)
    return Section(title, text, figures=((title, windows_figure(plant, log, horizon, models)),))


def _shown(found: RobotFit) -> Log:
    """Returns the first record that confirms, or else the log, over a horizon its unseen part."""
    robot = found.robot
    if robot.records:
        return robot.records[0]
    return robot.log if found.found.horizon is None else robot.log.part("validation")


def _given(found: RobotFit, log: Log) -> dict[str, float]:
    """Returns the values that a record gives, and where it begins."""
    robot = found.robot
    return {**robot.values_of(log), **(robot.started(log) if robot.records else {})}


def _values(found: RobotFit, log: Log) -> dict[str, float]:
    """Returns the values of the fitted model on a record, those of the record's own among them."""
    of_log: Mapping[str, tuple[float, float]] = {}
    if isinstance(found.found, RecordsFit):
        of_log = found.found.own.get(log.name, {})
    of_record = {n: value for n, (value, _) in of_log.items()}
    return {**found.shared, **of_record, **_given(found, log)}


def _free_run(found: RobotFit, log: Log) -> Figure:
    values = _values(found, log)
    begun = found.begun if log is found.robot.log else None
    predictor = Predictor(plant_with(found.robot, log, values, begun), log, (), values)
    simulated = np.asarray(predictor.predict(np.empty((1, 0)))[0])
    fit, names, unit = fit_percent(log.outputs, simulated), log.output_names, log.output_unit
    return compare_figure(log.time, log.outputs, simulated, fit, names, unit)
