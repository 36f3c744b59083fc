"""Refits of a first effect begin anew where the model without it went to a limit."""

import pytest
from discovery_cases import EFFECTS, OPTIONS, SENSOR, record, slider, task, wander

from identification.effects.effect import Candidate
from identification.innovations.fitted_model import (
    fit_model,
    list_parameters_at_limit,
    score_candidates,
)
from identification.innovations.moves import shapes as anew
from identification.innovations.moves.shapes import begin_anew
from identification.innovations.scoring.sensitivities import compute_sensitivities

K = 5.0
ROBOT = {"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02, "spring.k": K}
HIGHEST = 100.0  # of the slider's mass [kg]


@pytest.fixture(scope="module")
def asked():
    return task(record(slider(**ROBOT), 500, 11, wander(500, 0.003, 0.1, 8), SENSOR))


@pytest.fixture(scope="module")
def plain(asked):
    return fit_model(asked, (), {})


def candidate(name):
    return Candidate(next(e for e in EFFECTS if e.name == name), "joint", {})


def stuck(asked, name, size):
    """A refit that ended where it began, with a mass at the end of its range."""
    start = {"mass": 0.995 * HIGHEST, name: size}
    return fit_model(asked, (candidate(name.split(".")[0]),), start, steps=0)


def test_they_arrive_where_fits_from_the_nominal_values_arrive(asked, plain):
    scores = score_candidates(plain, compute_sensitivities(
        plain.refit.point, [candidate("spring"), candidate("offset")]), OPTIONS)  # fmt: skip
    refitted = [stuck(asked, "offset.f", 0.1), stuck(asked, "spring.k", 0.1)]
    assert list_parameters_at_limit(refitted[0]) == ("mass",)
    best, other = begin_anew(asked, refitted, scores)
    assert [m.candidates[0].effect.name for m in (best, other)] == ["spring", "offset"]
    assert best.refit.point.values["spring.k"] == pytest.approx(K, rel=0.05)
    assert list_parameters_at_limit(best) == ()
    for model, before in zip((other, best), refitted, strict=True):
        again = fit_model(asked, model.candidates, {})
        assert model.negative_bic == pytest.approx(again.negative_bic, abs=0.5)
        assert model.negative_bic > before.negative_bic


def test_nothing_changes_where_no_parameter_is_at_a_limit(asked, plain, monkeypatch):
    monkeypatch.setattr(anew, "try_fit", None)
    assert begin_anew(asked, [plain], ()) == [plain]
    assert begin_anew(asked, [], ()) == []
