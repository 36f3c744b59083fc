"""The level of the noise is found again in what it makes."""

import numpy as np
import pytest
from discovery_cases import STEP, covariance, linear_plant

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_fit import (
    FIRST_LEVELS,
    START_CORRELATION_TIME,
    compute_unit_ratio,
    evaluate_noise,
    fit_noise,
)
from identification.kalman.noise_model import Noise, whiten

SIGMA = 2e-3
TIME = START_CORRELATION_TIME


def cart(samples=150):
    """A double integrator with friction, as a drive is; force in, position out."""
    A = np.array([[1, STEP], [0, 0.96]])
    B = np.array([[STEP**2 / 2], [STEP]])
    A, B = (np.tile(M, (samples - 1, 1, 1)) for M in (A, B))
    return LinearPlant(A, B, np.array([[1.0, 0.0]]))


def drawn(plant, noise, rng, n):
    V = covariance(plant, noise)
    samples, ny = len(plant.B) + 1, len(plant.C)
    all_ = SIGMA * np.linalg.cholesky(V) @ rng.standard_normal((len(V), n))
    return all_.T.reshape(n, samples, ny)


def test_ratio_and_sigma_are_recovered_within_their_scatter():
    rng, plant, truth = np.random.default_rng(1), cart(250), Noise(300.0, 0.1)
    J = rng.standard_normal((250, 1, 2))
    found = [fit_noise(plant, e, J, np.zeros(2), STEP) for e in drawn(plant, truth, rng, 8)]
    # ρ √τ is what a slow plant feels: it is known better than either.
    felt = np.log([f.noise.ratio * f.noise.time**0.5 / (300 * 0.1**0.5) for f in found])
    sigma = np.array([f.sigma for f in found]) / SIGMA
    assert abs(np.median(felt)) < 0.35
    assert np.abs(felt).max() < 1.0
    assert abs(sigma.mean() - 1) < 0.07
    assert np.abs(sigma - 1).max() < 0.25


def test_the_correlation_time_is_told_from_others():
    rng, plant = np.random.default_rng(2), cart(250)
    J = np.zeros((250, 1, 0))
    for time in (0.03, 0.3):
        e = drawn(plant, Noise(400.0, time), rng, 1)[0]
        true, prior = Noise(400.0, time), np.zeros(0)
        found = fit_noise(plant, e, J, prior, STEP)
        assert time / 5 < found.noise.time < 5 * time
        at_truth = evaluate_noise(whiten(plant, J, true, STEP), e, prior)
        assert found.log_likelihood > at_truth.log_likelihood - 0.5  # as likely as the truth


def test_where_there_is_none_it_finds_none_or_what_no_output_notices():
    rng, plant = np.random.default_rng(3), cart()
    unit = compute_unit_ratio(plant, STEP, 0.03)
    J = rng.standard_normal((150, 1, 2))
    found = [
        fit_noise(plant, SIGMA * rng.standard_normal((150, 1)), J, np.zeros(2), STEP)
        for _ in range(12)
    ]
    assert np.mean([f.noise.ratio == 0 for f in found]) >= 0.4
    assert max(f.noise.ratio for f in found) < 0.5 * unit


@pytest.mark.parametrize("share", [0.0, 0.5])
def test_no_more_error_of_the_inputs_is_taken_for_granted_than_is_believed(share):
    rng, plant, truth = np.random.default_rng(5), cart(), Noise(300.0, 0.03)
    J, prior, e = np.zeros((150, 1, 0)), np.zeros(0), drawn(plant, truth, rng, 1)[0]
    free = fit_noise(plant, e, J, prior, STEP, fine=False)
    held = fit_noise(plant, e, J, prior, STEP, fine=False, largest=share * free.input_std)
    unit = Noise(compute_unit_ratio(plant, STEP, TIME), TIME)
    tried = [evaluate_noise(whiten(plant, J, n, STEP), e, prior)
             for n in map(unit.scaled, FIRST_LEVELS)]  # fmt: skip
    believed = [t.log_likelihood for t in tried if t.input_std <= share * free.input_std]
    assert held.input_std <= share * free.input_std
    assert held.log_likelihood == max(believed)
    again = fit_noise(plant, e, J, prior, STEP, free, fine=False, largest=share * free.input_std)
    assert again.input_std <= share * free.input_std


def test_a_slow_plant_feels_as_much_of_a_noise_that_lasts_longer():
    short = Noise(300.0, 0.01)
    long = short.lasting(0.04)
    assert long.ratio**2 * long.time == pytest.approx(short.ratio**2 * short.time)
    assert long.lasting(0.01) == short
    felt = [1 / compute_unit_ratio(cart(600), STEP / 20, n.time) * n.ratio for n in (short, long)]
    assert felt[0] == pytest.approx(felt[1], rel=0.15)


def test_the_likelihood_is_the_dense_gaussian_with_the_parameters_at_their_best():
    rng = np.random.default_rng(5)
    plant, noise = linear_plant(rng), Noise(0.5, 0.1)
    e, J = rng.standard_normal((40, 2)), rng.standard_normal((40, 2, 3))
    V, F = covariance(plant, noise), J.reshape(80, 3)
    iV = np.linalg.inv(V)
    rest = e.ravel() - F @ np.linalg.solve(F.T @ iV @ F, F.T @ iV @ e.ravel())
    squares = rest @ iV @ rest
    found = evaluate_noise(whiten(plant, J, noise, STEP), e, np.zeros(3))
    assert found.sigma == pytest.approx(np.sqrt(squares / 80), rel=1e-9)
    dense = -0.5 * (80 * np.log(squares / 80) + np.linalg.slogdet(V)[1])
    assert found.log_likelihood == pytest.approx(dense, rel=1e-9)


def test_what_no_output_feels_and_no_prior_holds_changes_nothing():
    """Such as an effect that would begin after the log has ended."""
    rng = np.random.default_rng(5)
    plant, noise = linear_plant(rng), Noise(0.5, 0.1)
    e, J = rng.standard_normal((40, 2)), rng.standard_normal((40, 2, 3))
    more = J[..., :1]
    both = np.concatenate([J, more], axis=2)
    one = evaluate_noise(whiten(plant, J, noise, STEP), e, np.zeros(3))
    other = evaluate_noise(whiten(plant, both, noise, STEP), e, np.zeros(4))
    assert other.log_likelihood == pytest.approx(one.log_likelihood, rel=1e-9)


def test_at_the_unit_ratio_input_errors_move_the_outputs_by_sigma():
    plant = linear_plant(np.random.default_rng(6))
    unit = compute_unit_ratio(plant, STEP, 0.1)
    moved = np.diag(covariance(plant, Noise(unit, 0.1))) - 1
    assert moved.reshape(40, 2)[1:].mean() == pytest.approx(1, rel=1e-9)
