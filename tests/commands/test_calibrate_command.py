"""inca calibrate as a user meets it: what it says, what it keeps, what it refuses."""

import json

import numpy as np
import pytest
from as_built_cases import deviations, log_as_built

from identification import write_log
from inca_mj.cli import main
from inca_mj.robot.geometry import read_geometry
from inca_mj.twin.saved import load_twin

TABLE = "[drives]\nK_t = 0.02\n[points]\nexit = 0.003\n"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("as built")
    write_log(log_as_built(1.5), folder / "a.csv")
    (folder / "mine.toml").write_text(TABLE)
    return folder


def test_a_folder_of_results_is_whole(files, tmp_path, capsys):
    out = tmp_path / "out"
    table = str(files / "mine.toml")
    assert main(["calibrate", str(files / "a.csv"), "--spread", table, "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "Calibrated from one record" in said
    assert "relative to one another" in said
    names = {path.name for path in out.iterdir()}
    assert {"model.xml", "effects.json", "geometry.toml", "report.html", "result.json",
            "exit_points.png", "drives.png"} <= names  # fmt: skip
    page = (out / "report.html").read_text()
    assert "torque constant K_t" in page
    assert "K_t@" not in page
    record = json.loads((out / "result.json").read_text())
    robot = load_twin(out)
    np.testing.assert_array_equal(robot.geometry.A, record["exits"])
    again = read_geometry(out / "geometry.toml")
    assert again == robot.geometry
    assert not again.assumed
    told = [row["value"] for row in record["drives"]["K_t"]]
    truth = [deviations()[f"K_t@{k}"] for k in range(1, 9)]
    assert np.corrcoef(told, truth)[0, 1] > 0.9


def test_what_is_wrong_is_said_in_one_sentence(files, capsys):
    arguments = ["{}/a.csv", "--spread", "huge"]
    assert main(["calibrate", *(a.format(files) for a in arguments)]) == 2
    said = capsys.readouterr().err
    assert "usual" in said
    assert "Traceback" not in said
