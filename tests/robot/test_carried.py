"""A fit hands its values with their std to the fit of the next log, and counts no log twice."""

import re
import shutil

import numpy as np
import pytest
from elbow_cases import ELBOW

from identification import fit, read_robot
from identification.errors import InputError
from identification.robot.file.carried import digest

pytestmark = pytest.mark.usefixtures("few_effects")


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A folder with a fit of the first record of the elbow, and the fit."""
    folder = tmp_path_factory.mktemp("kept")
    fitted = fit(read_robot(ELBOW / "elbow.toml", ELBOW / "first.csv"))
    return fitted.save(folder / "out"), fitted


def test_another_log_begins_at_the_fitted_values_with_their_std(kept):
    out, fitted = kept
    robot = read_robot(out / "robot.toml", ELBOW / "second.csv")
    assert robot.mean == pytest.approx(fitted.values)
    relative = [fitted.std[n] / v for n, v in fitted.values.items()]  # both stay positive
    np.testing.assert_allclose(robot.std, relative)
    assert any("count as known with their std" in remark for remark in robot.remarks)
    model = robot.nominal_model
    assert model.mean == robot.mean
    np.testing.assert_array_equal(model.std, robot.std)


def test_the_same_log_is_not_counted_twice(kept):
    out, fitted = kept
    before, again = (
        read_robot(path, ELBOW / "first.csv") for path in (ELBOW / "elbow.toml", out / "robot.toml")
    )
    np.testing.assert_array_equal(again.std, before.std)
    assert again.mean == before.mean
    assert again.plant.parameters["mass"].value == fitted.values["mass"]  # where it begins
    assert any("first was fitted before" in remark for remark in again.remarks)
    assert digest(before.log) != digest(read_robot(ELBOW / "elbow.toml", ELBOW / "second.csv").log)


def test_a_second_fit_is_nearer_to_the_first_than_without_it(kept):
    """Where the new log tells little, what was carried decides."""
    out, fitted = kept
    text = (out / "robot.toml").read_text()
    sure = re.sub(r"(?m)^std = .*$", "std = 1e-6", text)
    (out / "sure.toml").write_text(sure)
    second = fit(read_robot(out / "sure.toml", ELBOW / "second.csv"))
    assert second.values == pytest.approx(fitted.values, rel=1e-3)


def test_a_third_fit_of_the_second_log_knows_what_the_second_fit_knew(kept, tmp_path):
    out, _ = kept
    before = read_robot(out / "robot.toml", ELBOW / "second.csv")
    again = read_robot(fit(before).save(tmp_path / "out") / "robot.toml", ELBOW / "second.csv")
    assert again.mean == pytest.approx(before.mean)
    np.testing.assert_allclose(again.std, before.std)


def test_a_held_value_is_that_of_the_file_and_is_not_fitted(tmp_path):
    shutil.copy(ELBOW / "elbow.xml", tmp_path)
    text = (ELBOW / "elbow.toml").read_text().replace(
        'free = ["mass", "damping"]', 'free = ["damping"]\nheld = ["mass"]'
    )  # fmt: skip
    toml = tmp_path / "elbow.toml"
    toml.write_text(text.replace('unit = "kg"', 'unit = "kg"\nvalue = 1.35'))
    robot = read_robot(toml, ELBOW / "first.csv")
    assert robot.plant.model.body("forearm").mass[0] == 1.35
    fitted = fit(robot)
    assert [*fitted.values] == ["damping"]
    out = fitted.save(tmp_path / "out")
    again = read_robot(out / "robot.toml", ELBOW / "second.csv")
    assert again.file.held == ("mass",)
    assert again.plant.model.body("forearm").mass[0] == 1.35


@pytest.mark.parametrize(("was", "becomes", "said"), [
    ('free = ["mass", "damping"]', 'free = ["mass", "damping"]\nheld = ["mass"]',
     "mass under free and under held"),
    ('free = ["mass", "damping"]', 'free = ["damping"]\nheld = ["mass"]', "mass has no value"),
    ('free = ["mass", "damping"]', 'free = ["damping"]', "or name it under `held`"),
])  # fmt: skip
def test_what_is_held_is_told_once_and_with_a_value(was, becomes, said, tmp_path):
    shutil.copy(ELBOW / "elbow.xml", tmp_path)
    toml = tmp_path / "elbow.toml"
    toml.write_text((ELBOW / "elbow.toml").read_text().replace(was, becomes))
    with pytest.raises(InputError, match=re.escape(said)):
        read_robot(toml, ELBOW / "first.csv")
