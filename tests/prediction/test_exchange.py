"""Records exchange their roles: what holds for all stays, what one lacks is contradicted."""

from __future__ import annotations

from functools import cache

import pytest
from records_cases import FREE, HORIZON, nominal_model, pendulum, record, records

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates
from identification.prediction.discovery import discover_records
from identification.prediction.exchange import exchanged, is_contradicted
from identification.prediction.extension import with_effect
from identification.prediction.first_fit import begin
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.proof import find_doubt
from identification.prediction.records import as_records
from identification.prediction.scores import window_scores
from identification.prediction.unseen import compare

NAME, MU = "transmitted_load_friction", "transmitted_load_friction.mu@hinge"
LOAD = {MU: 0.15}
OPTIONS = DiscoveryOptions()
SAMPLES = 300  # of each record


def law():
    return [e for e in candidates(pendulum(), FREE) if e.name == NAME]


@cache
def pair(second):
    """Two fitted records, of which the second may lack the law, and two that confirm; models."""
    logs = records(4, LOAD, samples=500 if second == "lacks it" else SAMPLES)
    if second == "lacks it":
        logs[1] = record(2, plant=pendulum())
    every = as_records(logs[:2], logs[2:])
    without = fit_nominal(nominal_model(), every)
    begun = begin(without, window_scores(without.fit, list_common(law())))
    with_it = with_effect(without, begun, HORIZON, [r for r in every if r.role == "confirm"])
    return every, without, with_it


@cache
def other_side(second):
    every, *models = pair(second)
    return [exchanged(m, every, HORIZON) for m in models]


def test_the_model_with_roles_exchanged_is_that_of_a_fit_to_the_other_records():
    logs = records(4, samples=SAMPLES)
    model = fit_nominal(nominal_model(), as_records(logs[:2], logs[2:]))
    reverse = fit_nominal(nominal_model(), as_records(logs[2:], logs[:2]))
    found = exchanged(model, as_records(logs[:2], logs[2:]), HORIZON)
    for name in FREE:  # some of the windows, and a coarser end of the search
        assert found.values[name] == pytest.approx(reverse.values[name], abs=3 * reverse.std[name])
    assert [p.predictor.log.name for p in found.fit.problem.parts] == ["record 3", "record 4"]
    assert len(found.unseen.at_horizon) == 2


def test_a_law_of_all_records_is_the_same_from_both_sides():
    _, _, with_it = pair("has it")
    without, other = other_side("has it")
    assert other.values[MU] == pytest.approx(with_it.values[MU], abs=4 * with_it.std[MU])
    assert not is_contradicted(without, other, OPTIONS)


def test_a_law_that_one_fitted_record_lacks_is_proven_and_then_contradicted():
    _, without, with_it = pair("lacks it")
    assert find_doubt(compare(without.unseen, with_it.unseen), 1, OPTIONS) is None
    assert is_contradicted(*other_side("lacks it"), OPTIONS)


@pytest.mark.long
def test_what_is_contradicted_is_told_and_not_named():
    every, *_ = pair("lacks it")
    fit, confirm = ([r.log for r in every if r.role == role] for role in ("fit", "confirm"))
    said = []
    found = discover_records(nominal_model(), fit, confirm, law(), said.append)
    assert found.named == ()
    assert found.verdict == "unknown effect"
    assert [r.doubt for r in found.rejected] == ["exchange"]
    assert any("contradicted where the records exchange their roles" in line for line in said)
