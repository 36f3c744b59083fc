"""A friction that gives is found from its largest compliance, where a linear score is blind to it.

The records are integrated by scipy from equations of their own (`state_cases`).
"""

from functools import cache

import numpy as np
import pytest
from state_cases import F_C, Truth, measured, pendulum

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.plant.joint_plant import candidates
from identification.prediction.discovery import discover_records
from identification.prediction.moves.add_yielding_friction import _from_largest
from identification.prediction.state import first_state
from identification.prediction.task import RecordsTask
from identification.windows.records import as_records

FREE = ("J", "d", "coulomb_friction.f_c@hinge")
COMPLIANCES = (0.2, 0.8)  # [rad/(N m)]
RIGID = 0.0  # a smoothed friction that does not give
PASS = "add_yielding_friction"


def nominal():
    plant = pendulum(F_C, 0.0025).with_values({"J": 1.5e-3, "d": 0.03})
    return NominalModel(plant, FREE, np.full(3, 0.5), 0.2)


def effects(*names):
    return tuple(e for e in candidates(nominal().plant, FREE) if e.name in names)


@cache
def logs(c):
    truth = Truth(slip=c, f_c=F_C)
    return tuple(measured(truth, k, samples=100) for k in range(4))


@cache
def scored(c):
    """The nominal model of records with a compliance, and its linear score of presliding."""
    task = RecordsTask(
        nominal_model=nominal(), records=as_records(logs(c)[:2], logs(c)[2:]),
        effects=effects("presliding"), options=DiscoveryOptions(),
    )  # fmt: skip
    state = first_state(task, print)
    return state.model, state.scores[0]


@cache
def from_largest(c):
    return _from_largest(*scored(c), True)


@pytest.mark.parametrize("c", COMPLIANCES)
def test_a_fit_from_the_largest_compliance_finds_it_beyond_chance(c):
    found = from_largest(c)
    assert found.size[0] == pytest.approx(c, rel=0.15)
    assert found.fall > max(0.5, scored(c)[1].fall)
    assert found.p_value < 1e-6


def test_the_free_parameters_go_along_to_their_true_values():
    (model, _), found = scored(COMPLIANCES[0]), from_largest(COMPLIANCES[0])
    names = model.fit.problem.names
    values = dict(zip(names, model.fit.problem.prior.space.decode(model.fit.q + found.along),
                      strict=True))  # fmt: skip
    assert values["d"] == pytest.approx(0.02, rel=0.1)
    assert values[FREE[2]] == pytest.approx(F_C, rel=0.1)


def test_a_friction_that_holds_is_left_to_chance():
    assert from_largest(RIGID).p_value > 0.01


@pytest.mark.parametrize(("without", "names"), [((), ["presliding"]), ((PASS,), [])])
def test_it_is_named_where_its_score_is_blind_and_not_without_the_pass(without, names):
    c = COMPLIANCES[-1]
    options = DiscoveryOptions(max_effects=1, without=without)
    answer = discover_records(
        nominal(), logs(c)[:2], logs(c)[2:], effects("presliding"), options=options
    )
    assert [n.candidate.effect.name for n in answer.named] == names
    if names:
        assert answer.named[0].parameters["c"][0] == pytest.approx(c, rel=0.15)
