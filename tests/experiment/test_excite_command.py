"""identification excite: its CSV, sentences and keys; rivals are read from a saved discovery."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from pendulum_robot import TOML, make_folder, measured, written
from robot_cases import run

from identification import design_experiment, read_log, read_robot
from identification.robot.rivals import read_rivals

PAGE = (Path(__file__).parents[2] / "docs" / "json.md").read_text(encoding="utf-8")
NAMED, RIVAL = "coulomb_friction.f_c@hinge", "quadratic_friction.c@hinge"
SET = {
    "verdict": "named",
    "effects": [
        {"name": "coulomb_friction", "where": "joint hinge", "confidence": 0.55, "one_of": True,
         "rivals": [{"name": "quadratic_friction", "where": "joint hinge", "confidence": 0.4,
                     "values": {RIVAL: 2e-4}},
                    {"name": "unlisted", "where": "joint hinge", "confidence": 0.05}]}
    ],
}  # fmt: skip
SHORT = ("--budget", 4, "--seconds", 2, "--quiet")


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    folder = make_folder(tmp_path_factory.mktemp("excite"))
    (log,) = written(folder, measured(1, {NAMED: 4e-3}))
    return folder / "robot.toml", log


@pytest.fixture(scope="module")
def result(robot, tmp_path_factory):
    """The folder of a discovery that ended with a set, as `discover --out` writes it."""
    toml, log = robot
    folder = tmp_path_factory.mktemp("result")
    shutil.copy(toml.parent / "pendulum.xml", folder)
    more = f'\n[parameters."{NAMED}"]\nvalue = 4e-3\nknown = 0.3\n'
    (folder / "robot.toml").write_text(TOML.replace('"d"]', f'"d", "{NAMED}"]') + more)
    record = {**SET, "configuration": {"logs": [str(log)], "confirm": []}}
    (folder / "result.json").write_text(json.dumps(record))
    return folder


def test_the_csv_has_the_columns_of_the_log_and_can_be_played(robot, tmp_path, capsys):
    toml, log = robot
    out = tmp_path / "out"
    told = run(capsys, "excite", toml, "--log", log, "--out", out, *SHORT)
    played = read_log(out / told["file"], ["drive"], [] if told["form"] == "inputs" else ["angle"])
    assert played.duration == pytest.approx(2.0)
    assert played.sampling_time == pytest.approx(read_log(log, ["drive"], ["angle"]).sampling_time)
    assert np.allclose(played.inputs[[0, -1]], 0, atol=0.02)
    assert (out / "report.html").is_file()
    assert told["rivals"] == []
    for name in ("J", "d"):
        assert told["values"][name]["after"] <= told["values"][name]["before"]
    assert all(m["share"] >= 0 for m in told["margins"])
    known = set(re.findall(r"`(\w+)`", PAGE.split("## excite\n")[1].split("\n## ")[0]))
    inner = {k for row in (*told["values"].values(), *told["margins"]) for k in row}
    assert {*told} | inner <= known


def test_the_rivals_of_a_saved_discovery_are_models_of_the_robot(robot, result):
    _, log = robot
    named, rival = read_rivals(read_robot(result / "robot.toml", log), result)
    assert (named.share, rival.share) == (0.55, 0.4)
    assert NAMED in named.nominal.names
    assert NAMED not in rival.nominal.names
    assert RIVAL in rival.nominal.names
    values = rival.nominal.plant.parameters.values()
    assert values[NAMED] == 0
    assert values[RIVAL] == 2e-4
    assert len(rival.nominal.std) == len(rival.nominal.names)


def test_a_set_is_to_be_ended_by_the_next_experiment(robot, result, capsys):
    told = run(capsys, "excite", robot[0], result, *SHORT)  # the logs are those of the result
    first, second = told["rivals"]
    assert first["name"] == "coulomb_friction (joint hinge)"
    assert first["before"] == pytest.approx(0.55 / 0.95)
    assert first["after"] >= first["before"]
    assert second["after"] >= second["before"]
    assert told["log_odds"][0][1] > 0
    assert told["log_odds"][0][0] is None
    assert "apart" in " ".join(told["verdict"])


def test_python_designs_the_same(robot, result):
    toml, log = robot
    found = design_experiment(read_robot(toml, log), result, seconds=2, budget=4)
    assert [h.share for h in found.found.hypotheses] == [0.55, 0.4]
    assert found.log.duration == pytest.approx(2.0)
    assert {*found.after} == {*found.before} >= {"J", "d", NAMED}
