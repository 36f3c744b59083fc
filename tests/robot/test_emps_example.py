"""The axis of the example: its files hold the published values, and its records miss what is known.

The records are read from the folder EMPS_DATA, else from ../shared/data/emps.
"""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from identification import estimate_windows, read_robot, window_error

EXAMPLES = Path(__file__).parents[2] / "examples"
DATA = Path(os.environ.get("EMPS_DATA", EXAMPLES.parents[1] / "shared" / "data" / "emps"))
sys.path.insert(0, str(EXAMPLES))
import emps  # noqa: E402

sys.path.remove(str(EXAMPLES))
needs_records = pytest.mark.skipif(
    not (DATA / "DATA_EMPS.mat").exists(),
    reason="EMPS_DATA names no folder with DATA_EMPS.mat; get it from nonlinearbenchmark.org",
)


@needs_records
def test_its_files_hold_the_published_values_and_the_step_is_fine_enough():
    log = emps.read_emps(DATA / "DATA_EMPS.mat")
    robot = read_robot(emps.ROBOT, log.part("estimation"))
    own = robot.plant.parameters
    for name in robot.file.free:
        assert own[name].value == emps.PUBLISHED[name]
    assert log.sampling_time == pytest.approx(emps.EVERY * 1e-3)


@needs_records
def test_friction_that_differs_by_direction_predicts_pulses_that_were_not_fitted():
    log, pulses = (emps.read_emps(DATA / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    robot = read_robot(emps.ROBOT, log.between(0.0, 5.0))
    size = "asymmetric_viscous_friction.d_a@slide"
    fit = estimate_windows(robot.plant, robot.log, (*robot.file.free, size), 0.2, tolerance=1e-2)
    assert fit.values["M"] == pytest.approx(emps.PUBLISHED["M"], rel=0.05)
    assert fit.values[size] == pytest.approx(emps.PUBLISHED[size], rel=0.4)
    symmetric, ours = (
        np.mean(window_error(robot.plant, pulses.between(0.0, 8.0), 0.2, values) ** 2)
        for values in ({}, fit.values)
    )
    assert ours < 0.8 * symmetric
