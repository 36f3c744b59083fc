"""A wrong MUJOCO_GL ends no command that draws nothing."""

import os
import subprocess
import sys

import pytest
from robot_cases import write_slider
from sweep_cases import METHOD

from inca_mj.cli import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a robot, its log, and a sweep."""
    folder = tmp_path_factory.mktemp("robot")
    write_slider(folder)
    (folder / "sweep.toml").write_text(f"[[study]]\nmethod = '{METHOD}:TOSS'\n")
    return folder


LINE = "identification sweep sweep.toml --jobs 1 --out one"


def test_a_command_that_draws_nothing_runs(folder):
    done = subprocess.run(
        [sys.executable, "-m", *LINE.split()], cwd=folder, capture_output=True, text=True,
        env=os.environ | {"MUJOCO_GL": "bogus"}, check=False,
    )  # fmt: skip
    assert "MUJOCO_GL" not in done.stderr
    assert done.returncode == 0, done.stderr


def test_an_unknown_backend_of_matplotlib_is_none_of_the_programs(monkeypatch):
    """All figures are drawn without a screen; matplotlib's import fails under such a name."""
    monkeypatch.setenv("MPLBACKEND", "nonsense")
    assert main(["sensitivity", "--set", "nonsense"]) == 2
    assert os.environ["MPLBACKEND"] == "agg"
