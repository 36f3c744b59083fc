"""The horizon is predicted first; the other lengths only where it leaves something to decide."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import HORIZON, nominal_model, records

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.effects.joint_plant import candidates
from identification.prediction.crossing import at_all_lengths, at_their_best
from identification.prediction.model import predict_fitted
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records
from identification.prediction.screening import score_all
from identification.prediction.selection import REFUTED, refit_contenders
from identification.prediction.unseen import HORIZON as ALONE
from identification.prediction.unseen import compare

SAMPLES = 300  # of each record
MU = "transmitted_load_friction.mu@hinge"


@cache
def fitted(mu=0.15):
    """Records with friction under load, and the model without it."""
    logs = records(4, {MU: mu}, samples=SAMPLES)
    every = as_records(logs[:2], logs[2:])
    return [r for r in every if r.role == "confirm"], fit_nominal(nominal_model(), every)


def predicted(model, confirm, **lengths):
    return predict_fitted(model.plant, confirm, HORIZON, model.scale, model.fit, {}, **lengths)


def test_a_length_is_predicted_the_same_alone_and_with_others():
    confirm, model = fitted()
    whole, alone = predicted(model, confirm), predicted(model, confirm, lengths=ALONE)
    assert alone.lengths == ALONE
    for mine, other in zip(alone.at_horizon, whole.at_horizon, strict=True):
        np.testing.assert_array_equal(mine, other)
    rest = predicted(model, confirm, lengths=[n for n in whole.lengths if n not in ALONE])
    joined = alone.plus(rest)
    assert joined.lengths == whole.lengths
    for mine, other in zip(joined.squares, whole.squares, strict=True):
        np.testing.assert_array_equal(np.concatenate(mine), np.concatenate(other))
    np.testing.assert_array_equal(joined.fit_percent, whole.fit_percent)


def test_models_are_compared_over_the_lengths_that_both_have():
    confirm, model = fitted()
    whole, alone = model.unseen, predicted(model, confirm, lengths=ALONE)
    assert len(compare(whole, whole).falls) == len(whole.lengths)
    for pair in ((whole, alone), (alone, whole)):
        assert len(compare(*pair).falls) == 1
        assert compare(*pair).t == compare(*reversed(pair)).t == 0


def test_crossing_models_leaves_lengths_alone_that_nobody_begins_better():
    confirm, model = fitted()
    (offset,) = (e for e in candidates(model.plant, ("J", "d")) if e.name == "offset")
    child = replace(
        model, candidates=(Candidate(offset, "joint hinge", {}),),
        unseen=predicted(model, confirm, lengths=ALONE),
    )  # fmt: skip
    one, (other,) = at_their_best(model, [child], HORIZON, confirm)
    assert other.unseen.lengths == ALONE
    assert one.unseen.lengths == model.unseen.lengths
    for k, length in enumerate(one.unseen.lengths):
        if length not in ALONE:
            assert one.unseen.squares[k] is model.unseen.squares[k]
    _, (whole,) = at_all_lengths(one, [other], HORIZON, confirm)
    assert whole.unseen.lengths == model.unseen.lengths


@pytest.mark.parametrize("least", [DiscoveryOptions().min_proof_t, 1e3])
def test_what_the_horizon_refutes_is_predicted_over_no_other_length_and_the_rest_over_all(least):
    confirm, model = fitted()
    few = ("transmitted_load_friction", "quadratic_friction", "offset")
    effects = [e for e in candidates(model.plant, ("J", "d")) if e.name in few]
    scores = score_all(model, effects, DiscoveryOptions())
    options = DiscoveryOptions(min_proof_t=least)
    parent, tried = refit_contenders(model, scores, HORIZON, confirm, options, lambda _: None)
    assert tried[0].is_proven == (least < 1e3)
    for c in tried:
        lengths = ALONE if c.doubt in REFUTED else parent.unseen.lengths
        assert c.model.unseen.lengths == lengths
        assert len(c.prediction.falls) == len(lengths)
