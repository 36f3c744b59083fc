"""Fits over the windows of records, scores and comparisons, against slow obvious ways."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import (
    FREE,
    HORIZON,
    listed,
    nominal_model,
    pendulum,
    record,
    records,
    roles,
    with_law,
)

from identification.discovery.candidates import list_common
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.scoring.scores import find_imitated, window_scores
from identification.prediction.scoring.screening import has_what_it_needs
from identification.windows import point
from identification.windows.comparison import compare
from identification.windows.records import as_records
from identification.windows.unseen import predict

SAMPLES = 300  # of each record
LOAD = {"transmitted_load_friction.mu@hinge": 0.15}


def fitted(logs, confirm):
    base = nominal_model()
    return fit_nominal(base, as_records(logs, confirm))


@cache
def clean():
    logs = records(3, noise=1e-9, samples=SAMPLES)
    return fitted(logs[:2], logs[2:])


@cache
def noisy():
    logs = records(4, samples=SAMPLES)
    return fitted(logs[:2], logs[2:])


@cache
def rubbed():
    logs = records(4, LOAD, samples=SAMPLES)
    return fitted(logs[:2], logs[2:])


def scored(model, *names):
    return window_scores(model.fit, list_common(listed(*names)))


def test_clean_records_give_the_values_that_made_them():
    assert clean().values["J"] == pytest.approx(2e-3, rel=1e-4)
    assert clean().values["d"] == pytest.approx(0.02, rel=1e-4)


def test_slopes_that_are_kept_lead_to_the_same_fit_with_fewer_linearisations(monkeypatch):
    logs = records(4, LOAD, samples=SAMPLES)
    each = rubbed()
    # Slopes are kept, however few parameters there are.
    monkeypatch.setattr(point, "KEEP_SLOPES_FROM", 0)
    kept = fitted(logs[:2], logs[2:])
    assert kept.fit.cost == pytest.approx(each.fit.cost, rel=1e-3)
    for name in FREE:
        assert kept.values[name] == pytest.approx(each.values[name], abs=0.1 * each.std[name])
        assert kept.std[name] == pytest.approx(each.std[name], rel=0.02)


def test_the_order_of_records_changes_nothing():
    logs = records(4, samples=SAMPLES)
    a, b = noisy(), fitted(logs[1::-1], logs[:1:-1])
    for name in FREE:
        assert a.values[name] == pytest.approx(b.values[name], rel=1e-9)
    assert a.fit.cost == pytest.approx(b.fit.cost, rel=1e-9)


def test_the_same_records_twice_halve_the_variance():
    logs = records(4, samples=SAMPLES)
    # one record twice is refused; what differs by less than rounding of the fit is not
    again = [
        replace(log, name=f"{log.name} again", outputs=log.outputs + 1e-12) for log in logs[:2]
    ]
    once, twice = noisy(), fitted([*logs[:2], *again], logs[2:])
    for name in FREE:
        assert twice.values[name] == pytest.approx(once.values[name], rel=1e-3)
        assert once.std[name] / twice.std[name] == pytest.approx(2**0.5, rel=0.3)


def test_a_score_is_that_of_least_squares_with_columns_by_hand():
    model = rubbed()
    (score,) = scored(model, "quadratic_friction")
    fit, (name,) = model.fit, score.candidate.sizes
    part, t, d = fit.problem.parts[0], fit.tangents[0], fit.moves[0]
    assert len(fit.problem.parts) == 2
    columns, rests, bases = [], [], []
    probe = 1e-4 * score.candidate.effect.sizes[0].probe  # what is scored is a derivative
    for part, t, d in zip(fit.problem.parts, fit.tangents, fit.moves, strict=True):
        plant = part.predictor.plant.with_values({name: probe})
        moved = replace(part, predictor=replace(part.predictor, plant=plant))
        without, r = (p.joined(p.outputs(fit.q[None], [d], is_rough=True)[0], d)
                      for p in (part, moved))  # fmt: skip
        for w in range(len(d)):  # states of each window by hand: project on all that they can do
            U = t.U[w][:, t.s[w] > 0]
            P = np.eye(len(U)) - U @ U.T
            columns.append(P @ (without[w] - r[w]) / probe)
            rests.append(P @ t.r[w])
            bases.append(P @ t.S[w])
    below = np.diag(fit.problem.prior.weight)
    F = np.vstack([*bases, below])
    S = np.concatenate([*columns, np.zeros(len(below))])
    e = np.concatenate([*rests, fit.problem.prior.against(fit.q)])
    S, e = (x - F @ np.linalg.lstsq(F, x, rcond=None)[0] for x in (S, e))
    size = S @ e / (S @ S)
    assert score.size[0] == pytest.approx(size, rel=1e-4)
    assert score.fall == pytest.approx(size**2 * (S @ S) / (e @ e), rel=1e-4)


def test_a_child_never_explains_less_than_its_parent():
    parent, logs = rubbed(), records(4, LOAD, samples=SAMPLES)
    child = with_law(parent, "offset", roles(logs))
    assert child is None or child.fit.cost < parent.fit.cost


def test_a_model_predicts_no_better_than_itself():
    seen = clean().unseen
    same = compare(seen, seen)
    assert same.t == 0
    assert same.chance == 1
    assert set(same.gains) == {0.0} == set(same.falls)


def test_the_truth_predicts_unseen_records_down_to_the_noise():
    plant, confirm = pendulum(), as_records([record(9)], records(4)[3:])[1:]
    seen = predict(plant, confirm, HORIZON, np.array([3e-4]), {})
    (squares,) = seen.at_horizon
    # of 20 readings of a window two are spent on its state
    assert squares.mean() == pytest.approx(0.9, abs=0.15)


def test_a_parameter_without_effect_is_refused(refusal):
    base, logs = nominal_model(), records(2)
    more = replace(base, names=(*base.names, "cogging.n"), std=np.append(base.std, 1.0))
    said = refusal(fit_nominal, more, as_records(logs[:1], logs[1:]))
    assert "cogging.n has no effect" in said


def test_a_free_parameter_by_another_name_is_imitated_and_a_law_is_not():
    """The arm's inertia is free as its armature, so that no other inertia of it is missing."""
    found = scored(rubbed(), "inertia_mismatch", "transmitted_load_friction")
    known = find_imitated(rubbed().fit, found)
    assert {name for name, _ in known} == {"inertia_mismatch"}


def test_what_changes_a_level_of_friction_is_no_candidate_where_there_is_no_level():
    """One-sided friction and a constant force are Coulomb friction by another name."""
    model = rubbed()
    (effect,) = listed("asymmetric_friction")
    (candidate,) = list_common([effect])
    assert effect.needs == "coulomb_friction"
    assert not has_what_it_needs(model, candidate)
    (part,) = model.fit.problem.parts[:1]
    level = replace(
        part.predictor, plant=part.predictor.plant.with_values({"coulomb_friction.f_c@hinge": 0.1})
    )
    parts = (replace(part, predictor=level), *model.fit.problem.parts[1:])
    task = replace(model.fit.problem, parts=parts)
    assert has_what_it_needs(replace(model, fit=replace(model.fit, problem=task)), candidate)
