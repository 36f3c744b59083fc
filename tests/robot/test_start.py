"""A simulation begins where its log does, unless the file or trust say otherwise."""

from dataclasses import replace

import numpy as np
import pytest
from joint_cases import SLIDER, slider, slider_log, steps
from joint_cases import run as simulate
from pendulum_robot import MJCF, measured
from pendulum_robot import TOML as TOML_CLIPPED
from robot_cases import TOML

from identification import confirm, fit, read_robot, write_log
from identification.effects.plant.rows import read_model
from identification.robot.file.start import measured_begin
from identification.robot.reading import doubtful

pytestmark = pytest.mark.usefixtures("few_effects")

HELD = TOML.replace('"qpos[0]", "qvel[0]"', "").replace('.damping", ]', '.damping"]')
MODEL = read_model(SLIDER).compile()


@pytest.fixture(scope="module")
def late(tmp_path_factory):
    """A folder with a log that begins while the cart moves, and another one elsewhere."""
    path = tmp_path_factory.mktemp("late")
    (path / "slider.xml").write_text(SLIDER)
    (path / "held.toml").write_text(HELD)
    u = steps(1600)
    y = simulate(slider(), slider_log(u), mass=1.8, damping=3.6)
    y += 5e-4 * np.random.default_rng(3).standard_normal(y.shape)
    for name, rows in (("log", slice(205, 1405)), ("next", slice(405, 1600))):
        log = slider_log(u[rows], y[rows])
        write_log(replace(log, output_names=("x",), units={}), path / f"{name}.csv")
    return path


@pytest.mark.parametrize(("rate", "noise"), [(0.0, 0.0), (0.7, 0.0), (-0.7, 1e-3), (0.0, 1e-3)])
def test_position_and_rate_are_those_of_a_parabola_within_their_std(rate, noise):
    t, missed = 0.01 * np.arange(200), []
    for seed in range(40):
        e = noise * np.random.default_rng(seed).standard_normal(200)
        y = 0.3 + rate * t + 0.4 * t**2 + e
        found = measured_begin(MODEL, slider_log(np.zeros((200, 1)), y[:, None]))
        position, speed = found["qpos", 0], found["qvel", 0]
        missed.append([(position.value - 0.3) / position.std, (speed.value - rate) / speed.std])
    assert np.sqrt(np.mean(np.square(missed), axis=0)).max() < 1.5


def test_a_fit_begins_with_a_log_that_begins_in_motion(late):
    robot = read_robot(late / "held.toml", late / "log.csv", confirm=[late / "next.csv"])
    (said, other) = robot.remarks
    assert said.startswith("Simulations of log 'log' begin where it does, position at ")
    assert "the rate of position at " in said
    assert 'write trust = ["start"] into' in said
    assert "log 'next'" in other
    found = fit(robot)
    assert found.values["mass"] == pytest.approx(1.8, rel=0.05)
    (there,) = confirm(robot, found)
    assert there.after < 0.1 * np.ptp(robot.records[0].outputs)


def test_a_start_of_the_file_stands(late):
    path = late / "given.toml"
    path.write_text(HELD + '[start]\n"qpos[0]" = 0.05\n"qvel[0]" = 0\n')
    robot = read_robot(path, late / "log.csv")
    (said,) = robot.remarks
    assert f"[start] of {path} says, and it gives qpos[0] = 0.05 where position begins at" in said
    assert robot.plant.bare.start.qpos[0] == 0.05
    robot = read_robot(late / "held.toml", late / "log.csv", trust=["start"])
    assert robot.remarks == ()
    assert robot.plant.bare.start.qpos[0] == 0.0


def test_a_free_start_and_one_within_noise_are_not_remarked(folder):
    assert read_robot(folder / "robot.toml", folder / "other.csv").remarks == ()
    (folder / "held.toml").write_text(HELD)
    assert read_robot(folder / "held.toml", folder / "plain.csv").remarks == ()


def robot_in(folder, log, span):
    limit = "" if span is None else f' ctrllimited="true" ctrlrange="{-span} {span}"'
    (folder / "pendulum.xml").write_text(MJCF.replace("<motor", f"<motor{limit}", 1))
    (folder / "robot.toml").write_text(TOML_CLIPPED)
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


def test_repeated_samples_stand_beside_the_result(tmp_path):
    log = measured(3, samples=1200)
    y, late = log.outputs.copy(), np.arange(10, len(log), 12)
    y[late] = y[late - 1]
    write_log(replace(log, outputs=y), tmp_path / "log.csv")
    robot = robot_in(tmp_path, tmp_path / "log.csv", 1e3)
    (said,) = [r for r in robot.remarks if "repeat the one before" in r]
    assert said in doubtful(robot)
