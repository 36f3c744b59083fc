"""`inca cite`, figures of the thesis by number, a force, a saved twin, and what is refused."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from inca_mj.cli import main
from inca_mj.effects.platform import PULL
from inca_mj.report.citation import software, works
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.run import load_run, simulate
from inca_mj.twin.saved import save_twin
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.pulled import with_force

ROOT = Path(__file__).parents[2]


def run(*arguments):
    return main([str(a) for a in arguments])


def test_the_citation_file_is_what_the_program_cites():
    kept = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    for work in works():
        assert all(value in kept for name, value in work.items() if name not in ("key", "kind"))
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert f'version = "{software()["version"]}"' in project


def test_a_force_is_in_the_run_and_in_its_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = ("--force", 0, 0, -0.5, "--force-at", 0.01, 0, 0)
    assert run("simulate", "--input", "zero", "--duration", 0.2, *asked) == 0
    kept = load_run(tmp_path / "out" / "simulate" / "run.npz")
    right = with_force(build_twin(), (0, 0, -0.5), (0.01, 0, 0))
    np.testing.assert_array_equal(kept.qpos, simulate(right, kept.currents).qpos)
    assert kept.position[-1, 2] < kept.position[0, 2]


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """A twin with an effect, as a discovery leaves it."""
    folder = tmp_path_factory.mktemp("saved")
    robot = with_force(build_twin(parameter_set("trial", {"m": 0.2})), (0.2, 0.0, 0.0))
    save_twin(robot, folder)
    return folder, robot


def test_a_saved_twin_is_simulated_and_compared(saved, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder, robot = saved
    asked = ("simulate", "--model", folder, "--input", "prbs", "--duration", 0.5)
    assert run(*asked) == 0
    out = tmp_path / "out" / "simulate"
    kept = load_run(out / "run.npz")
    np.testing.assert_array_equal(kept.qpos, simulate(robot, make_input("prbs", 0.5)).qpos)
    assert [e.name for e in kept.twin.effects] == [PULL.name]
    capsys.readouterr()
    assert run("compare", out / "log.csv", "--model", folder, "--json") == 0
    assert json.loads(capsys.readouterr().out)["rms"] == [0.0] * 8


@pytest.mark.parametrize(("arguments", "said"), [
    (["simulate", "--figure", "2.17"], r"unknown figure '2\.17'; did you mean '2\.16'\?"),
    (["simulate", "--force", "1e9", "0", "0"], "outside its range"),
    (["simulate", "--model", "x", "--param", "m=0.2"], "--model is a whole robot"),
])  # fmt: skip
def test_what_cannot_be_is_refused(monkeypatch, capsys, tmp_path, arguments, said):
    monkeypatch.chdir(ROOT)
    out = [] if arguments[0] == "view" else ["--out", str(tmp_path / "out")]
    assert main([*arguments, *out]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert re.search(said, captured.err)
    assert not (tmp_path / "out").exists()
