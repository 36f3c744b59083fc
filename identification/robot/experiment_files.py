"""The files of the next experiment: its CSV, result.json and the report."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from identification.logs.csv_files import write_log
from identification.logs.log import Log
from identification.model.predictor import output_columns
from identification.report.experiment_sections import experiment_sections
from identification.report.experiment_words import (
    FILE,
    experiment_to_json,
    experiment_verdict,
)
from identification.report.page import Section, write_report
from identification.report.page_files import PageFiles
from identification.robot.next_experiment import NextExperiment

PLAYED = "Designed, not measured: inputs to play."
FOLLOWED = "Designed, not measured: positions to follow, and the inputs that the model expects."


@dataclass(frozen=True)
class ExperimentFiles(PageFiles):
    """The files of the next experiment."""

    of: NextExperiment  # the result

    @cached_property
    def record(self) -> dict[str, Any]:
        """The experiment as plain values."""
        return experiment_to_json(self.of.found, self.of.robot.plant.parameters)

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""
        return experiment_sections(self.of.found, self.of.robot.plant.parameters)

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write the CSV."""
        write_log(played_log(self.of), folder / FILE, digits=9)
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        robot = self.of.robot
        names = [log.name for log in (robot.log, *robot.others, *robot.records)]
        verdict = experiment_verdict(self.of.found, robot.plant.parameters)
        return write_report(path, "The next experiment", verdict, self.sections, data=names)


def played_log(of: NextExperiment) -> Log:
    """Returns what the CSV holds, in the columns of the robot's log.

    These are time and inputs and, where a motion is to be followed, the positions of its joints.
    Outputs that the model expects are left out: nobody shall take them for measured ones.
    """
    played, robot, stage = of.found.best.played, of.robot, of.found.stage
    log, columns = played.log, robot.file.columns
    data = {name: log.inputs[:, k] for k, name in enumerate(log.input_names)}
    followed = []
    if played.aim is not None:
        joints = [d.qpos for d in stage.drives if d is not None]
        for name, (field, i) in zip(log.output_names,
                                    output_columns(stage.model, log.output_names),
                                    strict=True):  # fmt: skip
            if field == "qpos" and i in joints:
                data[name] = played.aim[0][:, joints.index(i)]
                followed.append(name)
    factors = robot.log.factors
    data = {n: x / factors.get(columns.get(n, n), factors.get(n, 1.0)) for n, x in data.items()}
    outputs = [data[n] for n in followed]
    return replace(
        log,
        inputs=np.column_stack([data[n] for n in log.input_names]),
        outputs=np.column_stack(outputs) if outputs else np.zeros((len(log), 0)),
        input_names=tuple(columns.get(n, n) for n in log.input_names),
        output_names=tuple(columns.get(n, n) for n in followed),
        units={columns.get(n, n): u for n, u in log.units.items() if n in data},
        notes=FOLLOWED if followed else PLAYED,
        values={},
    )
