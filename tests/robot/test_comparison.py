"""Two models of a robot on one record, also where an effect has states of its own."""

import numpy as np
import pytest
from pendulum_robot import TOML, make_folder, written
from records_cases import records

from identification import read_robot, window_error
from identification.robot.record_error import compare_values

LOAD = {"presliding.c@hinge": 0.05}


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot")
    make_folder(folder)
    (folder / "robot.toml").write_text(TOML)
    written(folder, *records(2))
    return read_robot(folder / "robot.toml", folder / "log_0.csv", confirm=[folder / "log_1.csv"])


def test_an_effect_with_states_of_its_own_is_compared_in_a_plant_that_has_them(robot):
    (log,) = robot.records
    told = compare_values(robot, log, {}, {**LOAD, "coulomb_friction.f_c@hinge": 0.05})
    plant = robot.plant.with_states_of(LOAD)
    values = {**LOAD, "coulomb_friction.f_c@hinge": 0.05}
    error = window_error(plant, log, robot.file.horizon, values)
    assert told.after == pytest.approx(float(np.sqrt(np.mean(error**2))), rel=1e-12)
    assert told.after != told.before
