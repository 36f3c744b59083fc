"""`inca linearize` and `python -m identification linearize` as a user meets them."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from robot_cases import write_slider

from identification import load_grid, load_system
from identification.__main__ import main as identification
from inca_mj.cli import main as inca

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "json.md").read_text(encoding="utf-8")
KEYS = set(re.findall(r"`(\w+)`", PAGE.split("## linearize\n")[1].split("\n## ")[0]))
LOG = str(ROOT / "examples" / "log.csv")
GRID = ("--grid", "x=-0.2:0.2:2", "z=1.3:1.5:2", "--interpolation", "linear")


def keys_of(value, inside=""):
    if isinstance(value, list):
        return set().union(*(keys_of(v, inside) for v in value))
    if not isinstance(value, dict) or inside in ("axes", "point"):
        return set()  # these keys are names
    return set(value).union(*(keys_of(v, k) for k, v in value.items()))


def printed(capsys, main, *arguments):
    assert main(["linearize", *arguments, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert keys_of(record) <= KEYS
    return record


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("slider")
    write_slider(path, 300)
    return path


def test_at_a_pose_with_files_for_python_and_matlab(capsys, tmp_path):
    out = tmp_path / "out"
    record = printed(capsys, inca, "--pose", "0.1", "0", "1.4", "0", "0", "0.1", "--rate", "200",
                     "--out", str(out))  # fmt: skip
    (model,) = record["models"]
    assert len(model["states"]) == 36
    assert model["minimal"]["order"] == 28
    assert model["discrete"]["sampling_time"] == 1 / 200
    np.testing.assert_array_equal(load_system(out / "system.npz").A, model["A"])
    np.testing.assert_array_equal(load_system(out / "discrete.npz").B, model["discrete"]["B"])
    names = {p.name for p in out.iterdir()}
    assert {"system.mat", "minimal.mat", "report.html", "result.json"} <= names
    assert sum(name.endswith(".png") for name in names) == 3


def test_along_a_log_at_its_own_rate(capsys):
    models = printed(capsys, inca, "--log", LOG, "--time", "0", "0.5")["models"]
    assert [m["time"] for m in models] == [0.0, 0.5]
    assert models[0]["discrete"]["sampling_time"] == 0.01
    assert np.abs(models[1]["rate"]).max() > 1e-3


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_a_grid_is_kept_with_its_errors(capsys, tmp_path):
    out = tmp_path / "out"
    record = printed(capsys, inca, *GRID, "--out", str(out))["grid"]
    assert record["axes"] == {"x": [-0.2, 0.2], "z": [1.3, 1.5]}
    assert 0 < record["errors"]["matrix"] < 0.1
    grid = load_grid(out / "grid.npz")
    assert grid.A.shape == (2, 2, 36, 36)
    assert (out / "grid.mat").is_file()


def test_any_robot_at_rest_and_along_a_log(capsys, folder, tmp_path):
    robot, log = str(folder / "robot.toml"), str(folder / "log.csv")
    (point,) = printed(capsys, identification, robot)["points"]
    assert (point["time"], point["discrete"]) == (None, None)
    np.testing.assert_allclose(point["A"], [[0, 1], [0, -1.5]], atol=1e-8)
    out = tmp_path / "out"
    points = printed(capsys, identification, robot, log, "--time", "1", "2", "--out", str(out))
    assert [p["time"] for p in points["points"]] == [1.0, 2.0]
    assert points["points"][0]["discrete"]["sampling_time"] == 0.01
    assert load_system(out / "system_2.npz").sampling_time is None
    (point,) = printed(capsys, identification, robot, log, "--input", "force=0")["points"]
    assert point["time"] is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--pose", "0", "0", "1.4"), "six finite numbers"),
        (("--log", LOG), "--log and --time belong together"),
        (("--grid", "x=0:0.1:4", "x=0:0.1:4"), "gives x twice"),
    ],
)
def test_bad_input_of_inca_is_one_sentence(capsys, tmp_path, arguments, words):
    out = tmp_path / "out"
    assert inca(["linearize", *arguments, "--out", str(out)]) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1
    assert not out.exists()
