"""What unseen data say of a model, and what they say of two that are the same."""

from dataclasses import replace
from itertools import product

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
from discovery_cases import EFFECTS, OPTIONS, SENSOR, STEP, record, slider, task, wander
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import t as student

from identification.effects.effect import Candidate
from identification.innovations.fitted_model import fit_model
from identification.innovations.proof import allowed_chance, divide_unseen, flip_chance, prove
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
    assert seen.rms("report") == pytest.approx(np.sqrt(np.mean(seen.e[first:] ** 2)))
    assert seen.gap.rms == seen.rms("report")


def test_with_the_truth_the_free_run_errs_by_sensors_and_inputs(sprung):
    _, _, with_it = sprung
    seen = with_it.validation
    assert with_it.refit.level.sigma == pytest.approx(SENSOR, rel=0.15)
    floor = np.hypot(with_it.refit.level.sigma, seen.disturbance("report"))
    assert 0.3 * floor < seen.rms("report") < 3 * floor
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


GAINS = arrays.arrays(float, st.integers(2, 9), elements=st.integers(-50, 50).map(float))


@given(GAINS)
def test_the_chance_counts_every_flip_of_the_signs(gains):
    sums = [float(np.dot(signs, gains)) for signs in product((1, -1), repeat=len(gains))]
    assert flip_chance(gains) == np.mean(np.array(sums) >= gains.sum())


def test_blocks_that_all_gain_are_beyond_chance_though_few_gain_most():
    """A skew that makes Student's t small, and no doubt."""
    gains = np.array([400.0, 150.0, *np.full(18, 2.0)])
    t = gains.mean() / (gains.std(ddof=1) / np.sqrt(20))
    assert t < OPTIONS.min_proof_t
    assert flip_chance(gains) == 2.0**-20


def test_normal_gains_without_mean_pass_as_often_as_allowed():
    """At the level of Student's t, and for skewed losses less often."""
    rng = np.random.default_rng(4)
    allowed = allowed_chance(20, OPTIONS)
    assert allowed == pytest.approx(student.sf(2.0, 19))
    passed = np.mean([flip_chance(g) < allowed for g in rng.normal(size=(3000, 20))])
    assert abs(passed - allowed) < 4 * np.sqrt(allowed / 3000)


def test_a_short_log_keeps_all_unseen_samples_for_the_search(sprung):
    """Of 200 unseen samples two thirds would decide, and a search asks for 200 at least."""
    _, without, _ = sprung
    few = divide_unseen(without.validation, OPTIONS)
    np.testing.assert_array_equal(few.select, few.report)
    np.testing.assert_array_equal(few.select, ~without.validation.seen)
    some = divide_unseen(without.validation, replace(OPTIONS, min_samples=100))
    assert some.is_kept
    np.testing.assert_array_equal(some.select | some.report, few.select)
    left_out = replace(OPTIONS, min_samples=100, without=("untouched_part",))
    np.testing.assert_array_equal(divide_unseen(without.validation, left_out).report, few.report)
