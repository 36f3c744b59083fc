"""A simulation begins where its log does, unless the file or trust say otherwise."""

from dataclasses import replace

import numpy as np
import pytest
from joint_cases import SLIDER, slider, slider_log, steps
from joint_cases import run as simulate
from robot_cases import TOML, run

from identification import confirm, fit, read_robot, write_log
from identification.effects.rows import read_model
from identification.robot.start import measured_begin

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


def test_trust_is_repeated_on_the_command_line(folder, capsys):
    (folder / "held.toml").write_text(HELD)
    both = ["--trust", "start", "--trust", "wiring", "units"]
    said = run(capsys, "fit", folder / "held.toml", folder / "other.csv", *both)
    assert said["remarks"] == []
    assert len(read_robot(folder / "held.toml", folder / "other.csv").remarks) == 1
