"""inca kinematics as a user meets it."""

import json

import numpy as np
import pytest

from inca_mj import INCA, log_poses, read_inca_log
from inca_mj.cli import main
from inca_mj.kinematics import inverse


def run(*arguments):
    return main([str(a) for a in arguments])


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    """A short log of the twin with its pose."""
    out = tmp_path_factory.mktemp("run")
    assert run("simulate", "--input", "prbs", "--duration", 1, "--out", out / "run") == 0
    return out / "run" / "log.csv"


def test_a_pose_gives_its_cables(tmp_path, capsys):
    pose = [0.1, -0.2, 1.4, 0.0, -0.2, 0.1]
    assert run("kinematics", *pose, "--json", "--out", tmp_path / "k") == 0
    said = json.loads(capsys.readouterr().out)
    there = inverse(np.array(pose), INCA)
    assert said["lengths"] == there.lengths.tolist()
    assert said["directions"] == there.directions.tolist()
    assert said["cable_angles"] == there.angles.tolist()
    assert np.shape(said["jacobian"]) == (8, 6)
    assert said["rank"] == 6
    assert {p.suffix for p in (tmp_path / "k").iterdir()} == {".png", ".html", ".json"}
    assert run("kinematics", *pose, "--pulley", 0.03) == 0
    assert "Jacobian" in capsys.readouterr().out


def test_a_log_gives_its_poses_with_their_std(short, tmp_path, capsys):
    out = tmp_path / "k"
    assert run("kinematics", short, "--noise", 1e-4, "--std", "R=1e-5", "--json", "--out", out) == 0
    said = json.loads(capsys.readouterr().out)
    found = log_poses(read_inca_log(short), encoder=1e-4, std={"R": 1e-5})
    np.testing.assert_array_equal(said["pose"], found.pose)
    np.testing.assert_array_equal(said["std"], found.std)
    assert max(said["measured"]["rms"][:3]) < 1e-4
    rows = np.genfromtxt(out / "poses.csv", delimiter=",", names=True)
    np.testing.assert_allclose(rows["x"], found.pose[:, 0], atol=1e-9)
    np.testing.assert_allclose(rows["std_yaw"], found.std[:, 5], rtol=1e-8)
    np.testing.assert_allclose(rows["tension_8"], found.tension[:, 7], rtol=1e-8)
    assert (out / "report.html").exists()
