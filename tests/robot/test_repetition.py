"""A motion that repeats is no second witness; one that does not repeat is not blamed."""

import json
from dataclasses import replace

import numpy as np
import pytest
from joint_cases import SLIDER, run, slider, slider_log, steps
from robot_cases import TOML
from robot_cases import run as command

from identification import write_log
from identification.logs.replay import REPLAYED, replayed_share

NOISE = np.random.default_rng(2)


def moved(u):
    log = slider_log(u)
    y = run(slider(), log)
    return slider_log(u, y + 2e-4 * NOISE.standard_normal(y.shape))


def share(u):
    log = moved(u)
    return replayed_share([log.part("estimation")], log.part("validation"))


def test_a_sine_and_a_period_that_is_repeated_are_replayed():
    t = 0.01 * np.arange(2000)[:, None]
    assert share(np.sin(2 * np.pi * 0.7 * t)) > REPLAYED
    assert share(np.tile(steps(250), (8, 1))) > REPLAYED


@pytest.mark.parametrize("seed", range(5))
def test_random_steps_and_another_frequency_are_not(seed):
    t = 0.01 * np.arange(2000)[:, None]
    assert share(steps(2000, seed=seed)) < 0.5
    chirp = np.sin(2 * np.pi * (0.2 + (0.1 + 0.02 * seed) * t) * t)
    assert share(chirp) < REPLAYED


def test_a_replay_does_not_depend_on_units_and_constant_columns():
    log = moved(np.tile(steps(250), (8, 1)))
    parts = [log.part(p) for p in ("estimation", "validation")]
    other = [replace(p, outputs=1e3 * p.outputs + 7, units={}) for p in parts]
    assert replayed_share(other[:1], other[1]) == pytest.approx(replayed_share(parts[:1], parts[1]))
    still = replace(parts[1], inputs=0 * parts[1].inputs, outputs=0 * parts[1].outputs)
    assert replayed_share(parts[:1], still) == 0.0


def test_the_command_tells_it_in_words_and_in_json(tmp_path, capsys):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "robot.toml").write_text(TOML)
    log = moved(np.tile(steps(250), (5, 1)))
    write_log(replace(log, output_names=("x",), units={}), tmp_path / "log.csv")
    said = command(capsys, "fit", tmp_path / "robot.toml", tmp_path / "log.csv")
    (finding,) = said["findings"]
    assert finding["kind"] == "repeated motion"
    assert finding["share"] > REPLAYED
    assert any("repeats what was fitted: a replay" in sentence for sentence in said["verdict"])
    assert json.dumps(finding)
