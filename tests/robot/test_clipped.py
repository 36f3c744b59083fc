"""Inputs beyond the range of their actuator, which MuJoCo clips, are told."""

from dataclasses import replace

import numpy as np
import pytest
from pendulum_robot import MJCF, TOML, measured

from identification.robot.reading import doubtful, read_robot


def robot_in(folder, log, span):
    limit = "" if span is None else f' ctrllimited="true" ctrlrange="{-span} {span}"'
    (folder / "pendulum.xml").write_text(MJCF.replace("<motor", f"<motor{limit}", 1))
    (folder / "robot.toml").write_text(TOML)
    return read_robot(folder / "robot.toml", log)


@pytest.fixture(scope="module")
def log():
    return measured(3)


def test_what_is_cut_off_is_told_with_its_share_and_stands_beside_the_result(tmp_path, log):
    u = log.inputs[:, 0]
    span = round(0.5 * float(np.abs(u).max()), 3)
    robot = robot_in(tmp_path, log, span)
    (said,) = [r for r in robot.remarks if "ctrlrange" in r]
    assert f" {100 * np.mean(np.abs(u) > span):.0f} % lie beyond" in said
    assert said in doubtful(robot)


@pytest.mark.parametrize("span", [None, 1e3, "largest"])
def test_within_the_range_nothing_is_said(tmp_path, log, span):
    span = float(np.abs(log.inputs).max()) if span == "largest" else span
    assert not [r for r in robot_in(tmp_path, log, span).remarks if "ctrlrange" in r]


def test_noise_of_a_measured_input_at_its_limit_is_not_told(tmp_path, log):
    rng, span = np.random.default_rng(1), float(np.abs(log.inputs).max())
    noisy = replace(log, inputs=log.inputs + 0.003 * span * rng.standard_normal(log.inputs.shape))
    assert (np.abs(noisy.inputs) > span).any()
    assert not [r for r in robot_in(tmp_path, noisy, span).remarks if "ctrlrange" in r]
