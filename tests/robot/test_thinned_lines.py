"""Inputs that are straight lines between samples may be thinned: the values stay what they are."""

from dataclasses import replace

import numpy as np
import pytest
from pendulum_robot import TOML, make_folder, plant
from records_cases import NOISE, record

from identification import Predictor, fit, read_robot, write_log


@pytest.mark.parametrize(
    "every",
    [
        5,
    ],
)
def test_a_fit_of_a_thinned_log_is_unbiased(tmp_path, every):
    make_folder(tmp_path)
    (tmp_path / "robot.toml").write_text(f"every = {every}\n" + TOML)
    rng, n = np.random.default_rng(5), 1600
    t = 0.005 * np.arange(n)
    u = 0.5 * np.sin(7 * t) + 0.3 * np.sin(31 * t + 1) + 0.05 * rng.standard_normal(n)
    log = replace(
        record(samples=n), time=t, inputs=u[:, None], outputs=np.zeros((n, 1)), hold="foh"
    )
    y = Predictor(plant(), log, ()).predict(np.empty((1, 0)))[0]
    write_log(replace(log, outputs=y + NOISE * rng.standard_normal((n, 1))), tmp_path / "log.csv")
    robot = read_robot(tmp_path / "robot.toml", tmp_path / "log.csv")
    assert (robot.log.hold, len(robot.log)) == ("foh", (n - 1) // every + 1)
    found = fit(robot)
    for name, value in (("J", 2e-3), ("d", 0.02)):
        assert found.values[name] == pytest.approx(value, rel=0.005)
