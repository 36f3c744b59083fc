"""The program as a user meets it: JSON keys, files, exit codes."""

import json
from pathlib import Path

import numpy as np
import pytest

from identification import read_log, write_log
from inca_mj.cli import main
from inca_mj.twin.logs import ANGLES, CURRENTS, OPTIONAL, read_inca_log
from inca_mj.twin.run import load_run, simulate
from inca_mj.twin.twin import build_twin

LOG = Path(__file__).resolve().parents[2] / "examples" / "log.csv"


def run(*arguments):
    return main([str(a) for a in arguments])


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Where a run is kept that is not drawn."""
    monkeypatch.chdir(tmp_path)
    return tmp_path / "out" / "simulate"


def last_json(capsys):
    out = capsys.readouterr().out
    assert out.count("\n") == 1, "one JSON object on stdout and nothing else"
    return json.loads(out)


def test_a_simulated_log_is_explained_to_the_last_bit(kept, capsys):
    values = ("--param", "m=0.2", "x=0.01", "yaw=0.05")
    assert run("simulate", "--input", "multisine", "--duration", 1, *values) == 0
    capsys.readouterr()
    assert run("compare", kept / "log.csv", *values, "--json") == 0
    result = last_json(capsys)
    assert result["rms"] == [0.0] * 8
    assert result["fit_percent"] == [100.0] * 8


def test_simulate_keeps_states_tensions_figures_model_and_report(tmp_path):
    out = tmp_path / "a" / "b"
    assert run("simulate", "--input", "prbs", "--duration", 0.5, "--out", out) == 0
    names = {p.name for p in out.iterdir()}
    assert {"log.csv", "log.toml", "run.npz", "model.xml", "report.html", "result.json"} <= names
    assert len([n for n in names if n.endswith(".png")]) == 5  # currents, thesis Figure 2.16
    log = read_log(out / "log.csv", CURRENTS, ANGLES, OPTIONAL)
    assert set(log.extras) == set(OPTIONAL)
    again = load_run(out / "run.npz")
    replay = simulate(again.twin, again.currents)
    np.testing.assert_array_equal(replay.qpos, again.qpos)
    np.testing.assert_array_equal(log.extras["tension_3"], again.tension[:, 2])
    record = json.loads((out / "result.json").read_text())
    assert record["configuration"]["input"] == "prbs"
    assert {"mujoco", "numpy", "inca-mj"} <= set(record["versions"])


def test_simulate_samples_as_often_as_is_asked(kept, capsys):
    asked = ("simulate", "--duration", 0.2)
    assert run(*asked, "--rate", 250) == 0
    log = read_inca_log(kept / "log.csv")
    assert log.sampling_time == pytest.approx(0.004)
    assert len(log) == 51
    usual = simulate(build_twin(), np.repeat([[2.0] + 7 * [0.0]], 21, axis=0))
    np.testing.assert_allclose(log.outputs[::5], usual.motor_angle[::2], atol=1e-9)
    capsys.readouterr()
    for rate in (0, -1, "nan", "inf", 1e9):
        assert run(*asked, "--rate", rate) == 2
        assert "is not between 10 and 2000 Hz" in capsys.readouterr().err


def test_simulate_takes_the_currents_of_a_log(kept, tmp_path):
    log = read_inca_log(LOG).between(0.0, 2.0)
    write_log(log, tmp_path / "first.csv")
    assert run("simulate", "--input", tmp_path / "first.csv") == 0
    written = read_inca_log(kept / "log.csv")
    np.testing.assert_array_equal(written.inputs, log.inputs)


def test_crosscheck_disagrees_aloud(monkeypatch, capsys):
    """A reference of another robot must fail the check, with exit code 1."""
    from inca_mj.verification import check

    right = check.simulate_reference
    monkeypatch.setattr(
        check,
        "simulate_reference",
        lambda p, *rest, start: right(p.with_values({"b_c": 0.0051}), *rest, start=start),
    )
    assert run("crosscheck", "--duration", 0.3, "--states", 10, "--json") == 1
    assert last_json(capsys)["passed"] is False


def test_a_log_with_a_pose_begins_there(kept, capsys):
    moved = ("--param", "x=0.1", "z=1.3", "yaw=0.1")
    assert run("simulate", "--input", "prbs", "--duration", 1, *moved) == 0
    capsys.readouterr()
    assert run("compare", kept / "log.csv", "--json") == 0
    assert max(last_json(capsys)["rms"]) < 1e-9
