"""inca track as a user meets it."""

import json

import numpy as np
import pytest

from inca_mj.cli import main
from inca_mj.twin.run import load_run

SHORT = ("--radius", "0.05", "--duration", "5")


def test_it_keeps_a_run_that_can_be_loaded_and_says_how_far_off_it_was(tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["track", *SHORT, "--json", "--out", str(out)]) == 0
    said = json.loads(capsys.readouterr().out)
    kept = json.loads((out / "result.json").read_text())
    assert {key: kept[key] for key in said} == said
    assert 0 < said["rms"] < 1e-4
    assert said["rms"] <= said["largest"]
    run = load_run(out / "run.npz")
    distance = np.linalg.norm(run.position[run.time >= said["counted_from"], :2], axis=1)
    assert abs(distance - 0.05).max() <= said["largest"] + 1e-12
    error = np.linalg.norm(run.position - run.asked, axis=1)[run.time >= said["counted_from"]]
    assert error.max() == said["largest"]
    # On a circle the cross-track error is, to second order, what distance and height say.
    late = run.position[run.time >= said["counted_from"]]
    across = np.hypot(np.linalg.norm(late[:, :2], axis=1) - 0.05, late[:, 2] - 1.43)
    assert said["cross_track_rms"] == pytest.approx(np.sqrt(np.mean(across**2)), rel=0.02)
    assert said["cross_track_rms"] <= said["rms"]
    assert said["remarks"] == []
    assert run.currents.min() == said["current_min"] >= 0
    assert {p.name for p in out.iterdir()} >= {"log.csv", "model.xml", "report.html"}
    assert list(out.glob("*.png"))
