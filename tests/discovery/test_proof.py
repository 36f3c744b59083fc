"""What unseen data say of a model, and what they say of two that are the same."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import EFFECTS, OPTIONS, SENSOR, STEP, record, slider, task, wander

from identification.discovery.fitted_model import fit_model
from identification.discovery.proof import prove
from identification.effects.effect import Candidate
from identification.logs.joined import join_logs

SPRING = Candidate(EFFECTS[0], "joint", {})


@pytest.fixture(scope="module")
def sprung():
    """A log of a slider with a spring, its model without and with one."""
    error = wander(400, 0.02, 0.1, seed=5)
    log = record(slider(**{"spring.k": 6.0}), 400, seed=4, error=error)
    return log, fit_model(task(log), (), {}), fit_model(task(log), (SPRING,), {"spring.k": 2.0})


def test_a_model_proves_nothing_against_itself(sprung):
    _, without, _ = sprung
    proof = prove(without.validation, without.validation, OPTIONS)
    assert (proof.gain, proof.t, proof.share) == (0, 0, 0)


def test_what_is_there_is_proved_and_what_is_proved_can_be_disproved(sprung):
    _, without, with_it = sprung
    proof, back = (prove(*pair, OPTIONS) for pair in (
        (without.validation, with_it.validation), (with_it.validation, without.validation)
    ))  # fmt: skip
    assert proof.t > 2
    assert proof.gain > 0
    assert 0.5 < proof.share <= 1.2
    assert back.t < -2
    assert back.gain < 0
    assert back.share <= 0


def test_each_record_is_told_on_which_an_effect_does_not_hold():
    """Of three records two have the spring; a model with one harms the third."""
    springs = {"first": 6.0, "second": 6.0, "slack": 0.0}
    each = [
        replace(record(slider(**{"spring.k": k}), 300, seed=n), name=name)
        for n, (name, k) in enumerate(springs.items())
    ]
    both = join_logs(each)
    fits = [fit_model(task(both), c, v) for c, v in (((), {}), ((SPRING,), {"spring.k": 4.0}))]
    proof = prove(*(fit.validation for fit in fits), OPTIONS)
    assert "slack" not in proof.agrees
    assert proof.disagrees == ("slack",)
    assert {"first", "second"} == {*proof.agrees}


def test_the_unseen_samples_are_those_after_the_fitted_ones(sprung):
    log, without, _ = sprung
    seen = without.validation
    first = len(log.part("estimation"))
    np.testing.assert_array_equal(seen.seen, np.arange(len(log)) < first)
    fit = without.refit
    np.testing.assert_allclose(seen.e[:first], fit.point.e, atol=1e-12)
    assert seen.rms == pytest.approx(np.sqrt(np.mean(seen.e[first:] ** 2)))
    assert seen.gap.rms == seen.rms


def test_both_are_seen_through_the_filter_of_the_first(sprung):
    _, without, with_it = sprung
    first, second = without.validation, with_it.validation
    E = first.filter(second.e) / without.refit.level.sigma
    fewer = 0.5 * np.sum(first.innovations**2 - E**2, axis=1)[~first.seen]
    assert prove(first, second, OPTIONS).gain == pytest.approx(fewer.sum())


def test_with_the_truth_the_free_run_errs_by_sensors_and_inputs(sprung):
    _, _, with_it = sprung
    seen = with_it.validation
    assert with_it.refit.level.sigma == pytest.approx(SENSOR, rel=0.15)
    floor = np.hypot(with_it.refit.level.sigma, seen.disturbance)
    assert 0.3 * floor < seen.rms < 3 * floor
    assert STEP * len(seen.e) == pytest.approx(8.0)


def test_what_closes_the_gap_is_proved_where_the_inputs_have_no_noise():
    """The wrong model's predictor follows the data; the right one's free run errs by its std."""
    log = record(slider(mass=2.2, damping=2.7, x0=0.01, v0=0.02, **{"spring.k": 5.0}), seed=7)
    without, with_it = (
        fit_model(task(log), (), {}),
        fit_model(task(log), (SPRING,), {"spring.k": 5}),
    )
    proof = prove(without.validation, with_it.validation, OPTIONS)
    assert proof.share > 0.99
    assert proof.t > 2
