"""An angle and a way have no common rms: over a horizon too, each unit is told by itself."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from robot_cases import run
from unlike_cases import NOISE, TOML, write_robot_and_logs

from identification.prediction.record_errors import error_unit, errors_by_unit

PAIR = r"[\d.]+ [mµ]*rad{0} \(angles\) and [\d.]+ [mµ]*m{0} \(slides\)"
ERRORS, SIZES = PAIR.format(" rms"), PAIR.format("")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = write_robot_and_logs(tmp_path_factory.mktemp("unlike"))
    lines = TOML.replace("free = ", "horizon = 0.3\nfree = ").replace("robot.xml", "stiff.xml")
    stiff = (path / "robot.xml").read_text().replace('stiffness="200"', 'stiffness="201"')
    (path / "stiff.xml").write_text(stiff)
    known = "[effects]\njoints = ['slide']\nonly = ['stiffness', 'offset']\n"
    (path / "horizon.toml").write_text(lines + known)
    return path


def test_a_fit_over_a_horizon_tells_each_unit_by_itself(folder, capsys):
    logs = folder / "horizon.toml", folder / "first.csv", "--confirm", folder / "second.csv"
    said = run(capsys, "fit", *logs)
    text = " ".join(said["verdict"])
    for words in (
        rf"windows of 0.3 s leave {ERRORS}, [\d.]+ and [\d.]+ times the noise floor of {SIZES}\.",
        rf"On second: {ERRORS} with the values of the robot's file, {ERRORS} with those that were",
        r"A mean square over outputs of several units counts the error of each output in multiples",
    ):
        assert re.search(words, text), words
    for key in ("rms_by_unit", "validation_rms_by_unit", "noise_floor_by_unit"):
        assert said[key]["rad"] == pytest.approx(NOISE["turn"], rel=0.2), key
    (there,) = said["confirm"]
    (second,) = (r for r in said["records"] if r["role"] == "confirm")
    assert there["after_by_unit"] == second["after_by_unit"] == said["validation_rms_by_unit"]


def test_a_discovery_over_a_horizon_tells_each_unit_by_itself(folder, capsys, tmp_path):
    logs = folder / "horizon.toml", folder / "first.csv", "--confirm", folder / "second.csv"
    said = run(capsys, "discover", *logs, "--out", tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text()
    text = re.sub(r"</?span[^>]*>", "", page)
    assert re.search(rf"{SIZES}</td>", text)
    ways = f"from {ERRORS} to {ERRORS}|is {ERRORS} off|(noise,|It is) {ERRORS} over"
    assert re.search(ways, text)
    gap = said["gap"]
    assert set(gap["noise_rms_by_unit"]) == set(gap["after"]["rms_by_unit"]) == {"rad", "m"}
    assert set(said["records"][0]["before_by_unit"]) == {"rad", "m"}


def unlike(units):
    return SimpleNamespace(units=units, output_names=[*units])


def test_outputs_of_one_unit_have_the_error_over_all_outputs():
    rng = np.random.default_rng(0)
    scale, log = np.array([2e-3, 5e-3]), unlike({"a": "rad", "b": "rad"})
    log.output_unit = "rad"
    squares = rng.uniform(size=(7, 2))
    whole, _ = error_unit(log, scale)
    told = errors_by_unit(squares, scale, log)
    assert told == {"rad": pytest.approx(whole * np.sqrt(squares.mean()))}


def test_an_error_of_one_unit_does_not_depend_on_that_of_another():
    e = np.random.default_rng(1).standard_normal((7, 30, 2)) * (1e-3, 2e-5)
    for scale in (np.array([1e-3, 2e-5]), np.array([4e-3, 1.0])):
        squares = np.mean((e / scale) ** 2, axis=1)
        told = errors_by_unit(squares, scale, unlike({"turn": "rad", "way": "m"}))
        rms = np.sqrt(np.mean(e**2, axis=(0, 1)))
        assert told == {"rad": pytest.approx(rms[0]), "m": pytest.approx(rms[1])}
