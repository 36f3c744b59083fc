"""A fit of several logs is one fit: finer, confirmed on others, and honest where it fails."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from joint_cases import run as run_repetition
from joint_cases import slider, slider_log, steps
from pendulum_robot import TOML, assert_true, make_folder, measured, written
from robot_cases import refused, run

from identification import fit, read_robot
from identification.__main__ import main
from identification.logs.joined import REPLAYED, replayed_share
from identification.report.fit.window_words import blind_sentences
from identification.robot.file.file import read_robot_file
from identification.robot.results.fit_files import robot_fit_to_json

pytestmark = pytest.mark.usefixtures("few_effects")


@pytest.fixture
def folder(tmp_path):
    return make_folder(tmp_path)


def test_the_command_fits_several_logs_and_confirms_them_on_another(folder, capsys):
    *logs, other = written(folder, *map(measured, (1, 2, 3)))
    out = folder / "out"
    said = run(capsys, "fit", folder / "robot.toml", *logs, "--confirm", other, "--out", out)
    assert [(r["file"], r["role"]) for r in said["records"]] == [
        ("log_0", "fit"), ("log_1", "fit"), ("log_2", "confirm"),
    ]  # fmt: skip
    assert all(r["after"] < 0.5 * r["before"] for r in said["records"])
    (there,) = said["confirm"]
    assert (there["before"], there["after"]) == tuple(said["records"][2][k] for k in
                                                      ("before", "after"))  # fmt: skip
    assert said["validation_rms"] == pytest.approx(there["after"])
    assert sum("On log_2: " in sentence for sentence in said["verdict"]) == 1
    for name, true in (("J", 2e-3), ("d", 0.02)):
        p = said["parameters"][name]
        assert abs(p["value"] - true) < 4 * p["std"]
    again = read_robot_file(out / "robot.toml").records
    assert again["d"]["value"] == said["parameters"]["d"]["value"]


def test_more_logs_make_estimates_finer(folder):
    logs = written(folder, *(measured(k, samples=480) for k in (1, 2)))
    one, several = (fit(read_robot(folder / "robot.toml", paths)) for paths in (logs[0], logs))
    assert several.std["d"] < one.std["d"]
    assert_true(several, "d", 0.02)
    assert [c.log for c in several.unseen] == [f"log_{k} [validation]" for k in range(2)]
    assert several.converged
    assert not any(several.at_bound.values())
    assert several.start == {"J": pytest.approx(1.5e-3), "d": pytest.approx(0.03)}


def test_several_logs_need_a_horizon(folder, capsys):
    (folder / "robot.toml").write_text(TOML.replace("horizon = 0.2\n", ""))
    logs = written(folder, measured(1), measured(2))
    assert "write horizon = 0.2" in refused(capsys, "fit", folder / "robot.toml", *logs)


def test_what_cannot_be_known_apart_is_said(folder):
    text = TOML.replace('"d"]', '"d", "body/arm.inertia[1]"]')
    (folder / "robot.toml").write_text(text)
    found = fit(read_robot(folder / "robot.toml", *written(folder, measured(1))))
    (said,) = [s for s in robot_fit_to_json(found)["verdict"] if "tell less" in s]
    assert "J +" in said or "J -" in said
    assert "body/arm.inertia[1]" in said
    assert "d " not in said[said.index("(") : said.index(")")]
    total = found.values["J"] + found.values["body/arm.inertia[1]"]
    assert total == pytest.approx(2e-3 + 1e-3, rel=0.02)


def test_directions_that_are_not_told_stand_in_one_short_sentence():
    problem = SimpleNamespace(names=("a", "b", "c", "d"))
    blind = np.array([[0.7, -0.7, 0, 0], [0, 0, 0.6, 0.8], [0, 1, 0, 0]])
    record = SimpleNamespace(role="fit", log=SimpleNamespace(inputs=np.ones(2)))
    model = SimpleNamespace(fit=SimpleNamespace(problem=problem))
    several, single = blind_sentences(SimpleNamespace(model=model, blind=blind, records=[record]))
    assert "(a +0.70, b -0.70) and (d +0.80, c +0.60)" in several
    assert len(several.split()) < 60
    assert "less about b than was known" in single


def test_the_command_keeps_a_fit_that_is_worse_and_says_so_everywhere(folder, capsys):
    logs = written(folder, measured(1), measured(2, {"J": 1.5e-3, "d": 0.03}))
    out, robot = folder / "out", folder / "robot.toml"
    call = ["fit", str(robot), str(logs[0]), "--confirm", str(logs[1]), "--out", str(out)]
    assert main(call) == 1
    text, error = capsys.readouterr()
    assert "do not use them" in text.splitlines()[0]
    assert "run discover" in text.splitlines()[0]
    assert "run discover" in error
    assert "are not to be used (exit code 1)" in error
    kept = json.loads((out / "result.json").read_text())
    assert kept["worse"]["rise"] > 0
    assert "do not use them" in kept["verdict"][0]
    assert (out / "robot.toml").read_text().startswith("# The fitted values predict")
    again = read_robot_file(out / "robot.toml").records
    assert again["d"]["value"] == kept["parameters"]["d"]["value"]


def test_that_one_or_two_windows_tell_a_value_is_told(folder, capsys):
    logs = written(folder, measured(1, samples=40))
    said = run(capsys, "fit", folder / "robot.toml", *logs)
    assert all(p["std"] > 0 for p in said["parameters"].values())
    (sentence,) = [s for s in said["verdict"] if "One window tells" in s]
    assert sentence.startswith("One window tells the values of J, d. Their std is right if")
    assert sentence.endswith("record longer or give more logs.")


NOISE = np.random.default_rng(2)


def moved(u):
    log = slider_log(u)
    y = run_repetition(slider(), log)
    return slider_log(u, y + 2e-4 * NOISE.standard_normal(y.shape))


def share(u):
    log = moved(u)
    return replayed_share([log.part("estimation")], log.part("validation"))


def test_a_sine_and_a_period_that_is_repeated_are_replayed():
    t = 0.01 * np.arange(2000)[:, None]
    assert share(np.sin(2 * np.pi * 0.7 * t)) > REPLAYED
    assert share(np.tile(steps(250), (8, 1))) > REPLAYED


@pytest.mark.parametrize("seed", range(2))
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
