"""The files of a fit of a robot: result.json, robot.toml, and the report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from identification.estimation.metrics import fit_percent
from identification.logs.log import Log
from identification.model.predictor import Predictor
from identification.prediction.records_fit import RecordsFit
from identification.quantities import plain_unit, quantity
from identification.report.figures import compare_figure, windows_figure
from identification.report.fit_headline import fit_headline
from identification.report.page import Section, Table, write_report
from identification.report.page_files import PageFiles
from identification.report.value_words import value_words
from identification.robot.confirmation import confirm, plant_with
from identification.robot.fit_json import robot_fit_to_json
from identification.robot.record_error import AS_WRITTEN, FITTED
from identification.robot.robot_fit import RobotFit
from identification.robot.write import write_robot

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class RobotFitFiles(PageFiles):
    """The files of a fit of a robot."""

    fitted: RobotFit  # the result of the fit

    @cached_property
    def record(self) -> dict[str, Any]:
        """The fit as plain values, with how it predicts what it has not seen."""
        return robot_fit_to_json(self.fitted, confirm(self.fitted.robot, self.fitted))

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figure is drawn once."""
        return [_values_section(self.fitted), _error_section(self.fitted)]

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write robot.toml: the robot with the fitted values, as it is read from `place`."""
        found = self.fitted
        remark = self.record["verdict"][0] if found.is_worse or found.stopped else ""
        path = folder / "robot.toml"
        std = None if remark else found.std  # such values are not to be relied on
        write_robot(found.robot, found.shared, path, place, remark, found.own_values, std)
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        robot, found = self.fitted.robot, self.fitted
        logs = [log.name for log in (robot.log, *robot.others)]
        units = {p.name: plain_unit(p.unit) for p in robot.plant.parameters}
        return write_report(
            path,
            f"{', '.join(logs)}: fitted",
            self.record["verdict"],
            self.sections,
            good=False if found.is_worse else None,
            data=[*logs, *(log.name for log in robot.records)],
            headline=fit_headline(found.found, units),
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
    predictor = Predictor(plant_with(found.robot, log, values), log, (), values)
    simulated = np.asarray(predictor.predict(np.empty((1, 0)))[0])
    fit, names, unit = fit_percent(log.outputs, simulated), log.output_names, log.output_unit
    return compare_figure(log.time, log.outputs, simulated, fit, names, unit)
