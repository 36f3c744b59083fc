"""A search over a horizon that diverges is told with the factors of its logs, or with the step."""

from dataclasses import replace
from pathlib import Path

import pytest

from identification import fit, read_robot
from identification.errors import DivergenceError
from identification.robot import fitting

ELBOW = Path(__file__).parents[2] / "examples" / "elbow"


@pytest.fixture
def said(monkeypatch):
    """What a fit says that diverges, by the factors of its log."""

    def diverge(*_):
        raise DivergenceError("it diverged; use a smaller step")

    monkeypatch.setattr(fitting, "fit_records", diverge)
    robot = read_robot(ELBOW / "elbow.toml", ELBOW / "first.csv")

    def of(factors):
        with pytest.raises(DivergenceError) as caught:
            fit(replace(robot, log=replace(robot.log, factors=factors)))
        return str(caught.value)

    return of


@pytest.mark.parametrize(
    "column",
    [
        "current",
    ],
)
def test_a_factor_is_named_as_what_may_be_wrong(said, column):
    sentence = said({column: 1000.0})
    assert sentence.startswith("it diverged; use a smaller step. First see whether it is right: ")
    assert f"the factor 1000 of {column} under [factors] for log 'first', which makes" in sentence


@pytest.mark.parametrize(
    "factors",
    [
        {},
    ],
)
def test_without_one_the_place_of_the_step_is_told(said, factors):
    sentence = said(factors)
    assert "factor" not in sentence
    assert f"The step is timestep in <option> of {ELBOW / 'elbow.xml'}" in sentence
    assert f"the nominal values are those of {ELBOW / 'elbow.toml'}" in sentence
