"""The fit by innovations finds a slider's parameters, from afar, under noise of the input."""

from functools import cache

import numpy as np
import pytest
from discovery_cases import EFFECTS, FREE, OPTIONS, SENSOR, nominal_model, record, slider, wander

from identification.effects.effect import Candidate
from identification.estimation.estimation import estimate
from identification.estimation.priors import Priors
from identification.innovations.fit import fit_with_effects
from identification.kalman.estimate import estimate_innovations
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.kalman.problem import estimate_noise, linearise_criterion
from identification.kalman.refit import descend

ALLOWED = OPTIONS.allowed_input_error
TRUE = {"mass": 2.4, "damping": 2.6, "x0": 0.02, "v0": -0.03}


def fitted(log, start, candidates=()):
    return fit_with_effects(nominal_model(), log, candidates, start, OPTIONS)


def begun_at(log, start):
    """A fit of no step."""
    return fit_with_effects(nominal_model(), log, (), start, OPTIONS, steps=0)


@cache
def near():
    """A log whose input errs, and the fit from the truth."""
    log = record(slider(**TRUE), 300, seed=1, error=wander(300, 0.05, 0.1, seed=1))
    return log, fitted(log, TRUE)


@cache
def shaken():
    """A fit of no step to a log of a vibration, which no noise of the inputs is like."""
    t = 0.02 * np.arange(300)[:, None]
    log = record(slider(**TRUE), 300, seed=1, error=3.0 * np.sin(2 * np.pi * 4.1 * t))
    return begun_at(log, {})


@pytest.mark.parametrize("factors", [(2.0, 0.5), (2.5, 2.5)])
def test_it_finds_the_truth_from_far_starts_under_coloured_input_noise(factors):
    log, end = near()
    mass, damping = factors
    far = fitted(log, {"mass": 2.0 * mass, "damping": 3.0 * damping, "x0": 0.1, "v0": 0.1})
    # A search ends where the criterion would fall by less than the noise lets it.
    assert np.abs((far.point.q - end.point.q) / end.std).max() < 1
    assert far.point.values["mass"] == pytest.approx(2.4, rel=0.15)


def test_without_noise_it_finds_the_truth_as_it_is():
    log = record(slider(**TRUE), 200, noise=1e-7)
    found = fitted(log, {})
    for name in FREE:
        assert found.point.values[name] == pytest.approx(TRUE[name], rel=1e-3, abs=1e-5), name


def test_the_std_covers_under_coloured_input_noise():
    z = []
    for seed in range(10):
        log = record(slider(**TRUE), 200, seed=seed, error=wander(200, 0.1, 0.1, seed=100 + seed))
        found = fitted(log, TRUE)
        q = found.point.space.encode(np.array([TRUE[name] for name in FREE]))
        z.append((found.point.q - q) / found.std)
    z = np.array(z)
    # The mean square of 40 numbers of unit variance has a std of 0.22, of 10 one of 0.45.
    assert 0.5 < np.mean(z**2) < 2.0
    assert np.mean(np.abs(z) < 2) > 0.85


def test_an_effect_is_fitted_along_and_its_size_may_be_zero():
    found = {}
    for k in (0.0, 8.0):
        log = record(slider(**TRUE, **{"spring.k": k}), 200, seed=3)
        spring = Candidate(EFFECTS[0], "joint", {})
        found[k] = fitted(log, {"spring.k": 4.0}, (spring,)).point.values["spring.k"]
    assert found[8.0] == pytest.approx(8.0, rel=0.05)
    assert 0 <= found[0.0] < 0.3


def test_base_parameters_stay_within_a_factor_of_their_nominal_values():
    log = record(slider(mass=0.3), 200)
    assert fitted(log, {}).point.values["mass"] >= 2.0 / 3 - 1e-9


def test_a_search_ends_at_the_likeliest_point_since_its_noise_was_sharpened(monkeypatch):
    steps = 20
    begun = shaken()
    sharpened = []

    def spy(point, priors, near, fine=False, largest=np.inf):
        sharpened.append(fine)
        return estimate_noise(point, priors, near, fine, largest)

    for module in ("refit", "problem"):
        monkeypatch.setattr(f"identification.kalman.{module}.estimate_noise", spy)
    points = [*descend(begun.point, begun.priors, OPTIONS, steps=steps)]
    likely = [linearise_criterion(*p, begun.priors).log_posterior for p in points]
    assert sharpened.count(True) == 1
    assert sharpened.count(False) <= 1 + steps
    assert likely[-1] == max(likely[sharpened.index(True) :])


def test_a_fit_that_cannot_come_to_what_matters_ends_early_and_says_so():
    log = record(slider(**TRUE), 300, seed=3, error=wander(300, 0.1, 0.1, seed=3))
    far = {"mass": 5.0, "damping": 6.0}
    whole = fitted(log, far)
    below, above = (
        fit_with_effects(nominal_model(), log, (), far, OPTIONS, least=whole.log_posterior + more)
        for more in (-1.0, 10.0)
    )
    np.testing.assert_array_equal(below.point.q, whole.point.q)
    assert above.steps < whole.steps
    assert above.log_posterior < whole.log_posterior + 10.0


def test_likelihood_does_not_lead_where_inputs_err_beyond_belief_and_not_by_chance():
    begun = shaken()
    points = [*descend(begun.point, begun.priors, OPTIONS)]
    (end, level), levels = points[-1], [lv for _, lv in points]
    assert level.input_std > ALLOWED * end.motion  # which the vibration needs
    sharpened = levels.index(level)
    assert all(lv.input_std <= ALLOWED * end.motion for lv in levels[:sharpened])
    assert len(points) == sharpened + 1


def test_a_bent_step_follows_the_curve_of_the_residual_to_one_order_more():
    log, white = record(slider(**TRUE), 200, noise=1e-9), NoiseLevel(Noise(0.0, 0.1), 1.0, 0.0)
    left = {}
    for away in (0.2, 0.1):  # of the logarithm of the mass
        far = begun_at(log, {**TRUE, "mass": TRUE["mass"] * np.exp(away)}).point
        problem = linearise_criterion(far, white, Priors(far.space, far.q, np.zeros(4)))
        move = problem.step(0.0)
        bent = problem.bend(move, np.inf, 0.0)
        left[away] = [problem.cost_after(m) ** 0.5 for m in (move, bent)]
    (straight, bent), (straight_half, bent_half) = left[0.2], left[0.1]
    assert bent < 0.5 * straight
    assert straight / straight_half == pytest.approx(4, rel=0.2)  # second order
    assert bent / bent_half > 6  # third


def test_it_is_the_free_run_s_estimate_where_the_input_is_as_logged():
    log = record(slider(**TRUE), 400)
    found = estimate_innovations(slider(), log, FREE)
    free = estimate(slider(), log.part("estimation"), FREE).values
    for name, std in zip(FREE, found.fit.std, strict=True):
        assert abs(found.fit.estimate.values[name] - free[name]) < std, name


def test_where_the_input_errs_it_is_nearer_to_the_truth_than_a_free_run():
    off = []
    for seed in range(4):
        log = record(slider(**TRUE), 400, seed=seed, error=wander(400, 0.15, 0.1, seed=50 + seed))
        found = estimate_innovations(slider(), log, FREE).fit.estimate.values
        free = estimate(slider(), log.part("estimation"), FREE).values
        off.append([np.log(v["damping"] / TRUE["damping"]) for v in (found, free)])
    ours, theirs = np.sqrt(np.mean(np.square(off), axis=0))
    assert ours < theirs


def test_innovations_are_white_and_of_the_sensor_s_size_on_unseen_data_too():
    log = record(slider(**TRUE), 1000, seed=3, error=wander(1000, 0.1, 0.1, seed=4))
    found = estimate_innovations(slider(), log, FREE)
    assert found.fit.tests.white.min() > 1e-3
    assert found.level.sigma == pytest.approx(SENSOR, rel=0.15)
    assert found.validation_rms == pytest.approx(found.rms, rel=0.1)
    assert found.fit.rms > 2 * found.rms  # a free run adds up what disturbs it
    # A slow plant feels only the variance times the correlation time.
    felt = found.level.input_std**2 * found.level.noise.time / (0.1**2 * 0.1)
    assert 0.3 < felt < 3  # one draw of a slow error over some 100 correlation times
