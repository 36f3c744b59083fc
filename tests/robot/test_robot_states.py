"""A robot whose gear gives is written, read again, and fitted with the states that it needs."""

import numpy as np
import pytest
from pendulum_robot import TOML
from records_cases import MJCF
from state_cases import ELASTIC, Truth, elastic, measured

from identification import confirm, fit, read_robot, write_log
from identification.robot.write import write_robot


def test_an_elastic_gear_is_written_read_and_fitted(tmp_path):
    (tmp_path / "pendulum.xml").write_text(MJCF.replace('timestep="0.005"', 'timestep="0.0025"'))
    (tmp_path / "robot.toml").write_text(TOML)
    paths = [tmp_path / f"log_{k}.csv" for k in range(2)]
    for k, path in enumerate(paths):
        write_log(measured(Truth(c=0.05), k, samples=200), path)
    robot = read_robot(tmp_path / "robot.toml", paths[0], confirm=[paths[1]])
    found = {"J": 1.8e-3, "d": 0.03, **elastic(0.04)}
    again = read_robot(
        write_robot(robot, found, tmp_path / "new.toml", tmp_path), paths[0], confirm=[paths[1]]
    )
    assert [state.kind for state in again.plant.states] == ["motor"]
    fitted = fit(again)
    assert fitted.values[ELASTIC] == pytest.approx(0.05, rel=0.05)
    assert fitted.values["J"] == pytest.approx(2e-3, rel=0.02)
    (told,) = confirm(again, fitted)
    assert np.isfinite(told.after)
    assert told.after < 0.5 * told.before
