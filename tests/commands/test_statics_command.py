"""inca statics as a user meets it, and the analysis behind it."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from inca_mj.cli import main
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.parameters import GRAVITY, parameter_set
from inca_mj.statics.robot import pull
from inca_mj.statics.workspace import DriveLimits
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.statics import analyse_statics


def run(*arguments):
    return main([str(a) for a in arguments])


def test_json_has_the_documented_keys(capsys):
    assert run("statics", "--workspace", "closure", "--cells", 6, "--rho", 0.001, "--json") == 0
    out = capsys.readouterr().out
    assert out.count("\n") == 1
    found = json.loads(out)
    assert set(found) == {
        "pose", "load", "closure", "tension", "rest", "stiffness", "modes", "workspace",
        "interference", "cable_mass", "cable_modes",
    }  # fmt: skip
    told = (Path(__file__).parents[2] / "docs" / "json.md").read_text(encoding="utf-8")
    for key, value in found.items():
        assert f"`{key}`" in told
        inner = value[0] if isinstance(value, list) and isinstance(value[0], dict) else value
        for name in inner if isinstance(inner, dict) else ():
            assert f"`{name}`" in told, f"{key}: {name}"
    assert found["closure"]["closed"]
    assert found["workspace"]["volume"] > 10 * found["workspace"]["std"] > 0
    np.testing.assert_allclose(found["rest"]["pose"], [0, 0, 1.43, 0, 0, 0], atol=1e-9)


def test_out_gets_figures_and_a_report(tmp_path):
    out = tmp_path / "statics"
    assert run("statics", "--pose", 0.1, 0, 1.3, 0, 0, 0.05, "--rho", 0.001, "--out", out) == 0
    names = {p.name for p in out.iterdir()}
    assert {"report.html", "result.json", "tensions-of-the-cables.png"} <= names
    assert len([n for n in names if n.endswith(".png")]) == 3  # no workspace was asked for
    assert "wrench" not in (out / "report.html").read_text(encoding="utf-8")


def test_tensions_and_currents_hold_the_load():
    pose, load = np.array([0.3, 0.2, 1.2, 0.05, 0.0, 0.1]), np.array([0.2, 0, -1.0, 0, 0.01, 0])
    found = analyse_statics(pose=pose, load=load)
    held, at = found.held, inverse(pose, found.robot.geometry)
    m = parameter_set("trial").values()["m"]
    for T in (held.nearest, held.minimum_norm, held.within):
        np.testing.assert_allclose(at.W @ T, np.r_[0, 0, m * GRAVITY, 0, 0, 0] - load, atol=1e-7)
    assert np.linalg.norm(held.minimum_norm) <= np.linalg.norm(held.within)
    assert np.linalg.norm(held.nearest - 4) <= np.linalg.norm(held.within - 4) + 1e-9
    np.testing.assert_allclose(
        pull(found.robot, at.lengths, held.current).tension, held.within, atol=1e-8
    )
    low, high = DriveLimits().current
    assert (low <= held.current).all()
    assert (held.current <= high).all()
    assert len(found.modes.frequency) == len(found.modes_free.frequency) == 6


def test_the_twin_stays_where_the_currents_hold_it():
    """Rest at the pose of a run under the currents that `held` names for that pose."""
    pose = np.array([0.05, 0.02, 1.38, 0.0, 0.0, 0.02])
    found = analyse_statics(pose=pose)
    run_ = simulate(build_twin(), np.tile(found.held.current, (5000, 1)), 0.01)
    np.testing.assert_allclose(run_.position[-1], pose[:3], atol=5e-4)
    np.testing.assert_allclose(run_.angles[-1], pose[3:], atol=3e-3)


def test_cables_are_watched_along_a_log():
    run_ = simulate(build_twin(), np.full((50, 8), 0.3), 0.01)
    log = run_to_log(run_)
    found = analyse_statics(log=log).nearness_along
    assert found.between.shape == (50, 24)
    # without the measured pose it follows from the angles, to the strain of the cables
    units = {name: log.units[name] for name in (*log.input_names, *log.output_names)}
    again = analyse_statics(log=replace(log, extras={}, units=units)).nearness_along
    np.testing.assert_allclose(again.between, found.between, atol=2e-3)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--pose", 0, 0, 5, 0, 0, 0), "cannot be reached: z = 5 m lies outside the frame"),
        (("--current", 0.0, 0.001, "--pose", 0.2, 0, 1.2, 0, 0, 0), "no tensions between"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(capsys, tmp_path, arguments, sentence):
    out = tmp_path / "out"
    assert run("statics", *arguments, "--out", out) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert re.search(sentence, said.err)
    assert not out.exists()
