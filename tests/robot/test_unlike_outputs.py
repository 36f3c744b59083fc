"""An angle and a way have no common rms: a free run tells the error of each unit."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from robot_cases import run
from unlike_cases import MODEL, NOISE, TOML, TRUE, write_robot_and_logs

from identification import fit, read_robot
from identification.estimation.metrics import relative
from identification.prediction.fits.record_errors import error_of_all, errors_by_unit
from identification.report.fit.verdict import fit_verdict
from identification.robot.results.fit_files import worse_unit
from identification.robot.results.record_error import AS_WRITTEN, FITTED, Confirmation

pytestmark = pytest.mark.usefixtures("few_effects")

PAIR = r"[\d.]+ [mµ]*rad{0} \(angles\) and [\d.]+ [mµ]*m{0} \(slides\)"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_robot_and_logs(tmp_path_factory.mktemp("unlike"))


def test_each_unit_has_the_weight_of_its_noise(folder):
    found = fit(read_robot(folder / "robot.toml", folder / "first.csv")).found
    weight = np.diag(found.estimate.whitener)
    assert weight == pytest.approx([1 / e for e in NOISE.values()], rel=0.1)
    assert np.sqrt(np.mean((found.residual * weight) ** 2, axis=0)) == pytest.approx(1, rel=0.1)
    for name, value in TRUE.items():
        k = found.found.names.index(name)
        assert abs(found.estimate.values[name] - value) < 4 * found.std[k]


def test_an_error_of_one_unit_is_not_hidden_by_the_other(folder):
    """What lacks of the slide is many times its noise, and small beside an angle in SI units."""
    path = folder / "soft.toml"
    (folder / "soft.xml").write_text(MODEL.replace('stiffness="200"', 'stiffness="197"'))
    path.write_text(TOML.replace("robot.xml", "soft.xml"))
    found = fit(read_robot(path, folder / "first.csv")).found
    assert found.rms < 1.2 * np.sqrt(np.mean(found.floor**2))
    assert "That is more than noise" in " ".join(fit_verdict(found))


def test_relative_errors_are_the_same_in_every_unit():
    errors, of = {"rad": 3.0, "m": 4.0}, {"rad": 1.5, "m": 1.0}
    assert relative(errors, of) == pytest.approx(np.sqrt(10))
    in_mm = {"rad": 3.0, "m": 4e3}, {"rad": 1.5, "m": 1e3}
    assert relative(*in_mm) == pytest.approx(relative(errors, of))
    assert relative(errors, {"rad": 0.0, "m": 1.0}) == np.inf
    assert relative({"rad": 3.0}, {"rad": 1.5}) == 2.0


def confirmation(before, after):
    return Confirmation("log", 1.0, 0.9, "", (AS_WRITTEN, FITTED), before, after)


def test_no_outputs_are_called_worse_that_are_not_given_up_for_others_in_all_records():
    one = confirmation({"m": 1.0, "rad": 1.0}, {"m": 0.5, "rad": 1.2})
    other = confirmation({"m": 1.0, "rad": 2.0}, {"m": 0.5, "rad": 1.0})
    assert worse_unit([one])
    assert not worse_unit([one, other])
    assert not worse_unit([confirmation({"m": 1.0, "rad": 1.0}, {"m": 0.9, "rad": 0.9})])
    assert not worse_unit([confirmation({"rad": 1.0}, {"rad": 2.0})])  # has its own sentence


ERRORS, SIZES = PAIR.format(" rms"), PAIR.format("")


@pytest.fixture(scope="module")
def over_windows(tmp_path_factory):
    path = write_robot_and_logs(tmp_path_factory.mktemp("unlike"))
    lines = TOML.replace("free = ", "horizon = 0.3\nfree = ").replace("robot.xml", "stiff.xml")
    stiff = (path / "robot.xml").read_text().replace('stiffness="200"', 'stiffness="201"')
    (path / "stiff.xml").write_text(stiff)
    (path / "horizon.toml").write_text(lines)
    return path / "horizon.toml", path / "first.csv", "--confirm", path / "second.csv"


def test_a_fit_over_a_horizon_tells_each_unit_by_itself(over_windows, capsys):
    said = run(capsys, "fit", *over_windows)
    text = " ".join(said["verdict"])
    for words in (
        rf"windows of 0.3 s of first leave {ERRORS}, [\d.]+ and [\d.]+ times the noise floor of"
        rf" {SIZES}\.",
        rf"On second: {ERRORS} with the values of the robot's file, {ERRORS} with those that were",
        r"Before outputs of several units are taken together in one mean square, the error of each",
    ):
        assert re.search(words, text), words
    for key in ("rms_by_unit", "validation_rms_by_unit", "noise_floor_by_unit"):
        assert said[key]["rad"] == pytest.approx(NOISE["turn"], rel=0.2), key
    (there,) = said["confirm"]
    (second,) = (r for r in said["records"] if r["role"] == "confirm")
    assert there["after_by_unit"] == second["after_by_unit"] == said["validation_rms_by_unit"]


def unlike(units):
    return SimpleNamespace(units=units, output_names=[*units])


def test_what_is_told_of_outputs_of_one_unit_is_their_error_whatever_they_weigh():
    e = np.random.default_rng(0).standard_normal((7, 30, 2)) * (1e-3, 4e-3)
    log = unlike({"a": "rad", "b": "rad"})
    for scale in (np.array([2e-3, 5e-3]), np.array([1.0, 1e-5])):
        squares = np.mean((e / scale) ** 2, axis=1)
        rms = pytest.approx(np.sqrt(np.mean(e**2)))
        assert error_of_all(squares, scale, log) == rms
        assert errors_by_unit(squares, scale, log) == {"rad": rms}


def test_outputs_of_several_units_are_weighed_by_their_scales():
    e = np.random.default_rng(2).standard_normal((7, 30, 2)) * (1e-3, 2e-5)
    scale, log = np.array([4e-3, 1.0]), unlike({"turn": "rad", "way": "m"})
    weighed = np.sqrt(np.mean((e / scale) ** 2))
    assert error_of_all(np.mean((e / scale) ** 2, axis=1), scale, log) == pytest.approx(weighed)


def test_an_error_of_one_unit_does_not_depend_on_that_of_another():
    e = np.random.default_rng(1).standard_normal((7, 30, 2)) * (1e-3, 2e-5)
    for scale in (np.array([1e-3, 2e-5]), np.array([4e-3, 1.0])):
        squares = np.mean((e / scale) ** 2, axis=1)
        told = errors_by_unit(squares, scale, unlike({"turn": "rad", "way": "m"}))
        rms = np.sqrt(np.mean(e**2, axis=(0, 1)))
        assert told == {"rad": pytest.approx(rms[0]), "m": pytest.approx(rms[1])}
