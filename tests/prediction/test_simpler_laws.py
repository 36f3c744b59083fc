"""A law with fewer numbers than the best effect is scored and begins where that one ended."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import pytest
from records_cases import FREE, listed, nominal_model, records, roles, with_law

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.extension import at_values_of
from identification.prediction.scoring.scores import window_scores
from identification.prediction.selection import simpler_laws as module
from identification.prediction.selection.simpler_laws import is_dear, likelier, simpler_laws

SIZE = "hardening.k_3@hinge"
STIFF = 0.2  # of a spring that hardens [N m/rad³], for which the fit without it makes up


@cache
def models():
    """The fit without the spring, and the one with a curve of the position."""
    logs = roles(records(4, {SIZE: STIFF}, samples=500))
    bare = fit_nominal(nominal_model(), logs)
    return bare, with_law(bare, "curve_position", logs)


def scored(model):
    """The score of the spring about a model."""
    (best, *_) = window_scores(model.fit, list_common(listed("hardening")))
    return best


def test_a_model_at_the_values_of_another_is_no_fit():
    bare, curved = models()
    there = at_values_of(bare, curved)
    assert there.candidates == bare.candidates
    for name in FREE:
        assert there.values[name] == pytest.approx(curved.values[name], rel=1e-9)
        assert abs(there.values[name] / bare.values[name] - 1) > 0.01
    assert there.fit.cost > bare.fit.cost


def test_a_law_explains_more_at_the_values_of_a_curve_whose_windows_have_settled():
    bare, curved = models()
    there = at_values_of(bare, curved)
    assert 1 - scored(there).fall < 0.8 * (1 - scored(bare).fall)
    assert there.fit.cost < 2 * bare.fit.cost  # at the states of the curve it is 26 times as much


def test_the_simpler_laws_of_a_curve_are_those_of_its_joint_and_begin_where_it_ended():
    bare, curved = models()
    effects = listed("hardening", "offset", "curve_position", "delay")
    scores = window_scores(bare.fit, list_common(effects))
    best = SimpleNamespace(model=curved, candidate=curved.candidates[-1])
    there, simpler = simpler_laws(bare, best, scores, DiscoveryOptions(), False)
    assert simpler[0].candidate.effect.name == "hardening"
    assert {s.candidate.effect.name for s in simpler} <= {"hardening", "offset"}
    assert there.values["J"] == pytest.approx(curved.values["J"], rel=1e-9)


def test_of_two_fits_of_an_effect_the_one_that_explains_more_stays():
    _bare, curved = models()
    worse = replace(curved, scale=0.5 * curved.scale)  # twice the error in these units
    spring = replace(curved, candidates=tuple(list_common(listed("hardening"))))
    assert likelier([worse, spring, curved]) == [spring, curved]


@pytest.mark.parametrize(("doubt", "against", "dear"), [
    ("numbers", None, True), ("numbers", "chance", False), ("record", None, False),
    (None, None, False),
])  # fmt: skip
def test_only_the_price_of_its_numbers_may_be_against_an_effect_that_counts_as_a_winner(
    monkeypatch, doubt, against, dear
):
    monkeypatch.setattr(module, "find_doubt", lambda *_: against)
    c = SimpleNamespace(doubt=doubt, prediction=None)
    assert is_dear(c, 3, DiscoveryOptions()) == dear
