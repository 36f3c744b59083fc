"""How noise is shared out: σ of each sensor and ρ of the inputs are found."""

import numpy as np
import pytest
from discovery_cases import (
    OPTIONS,
    STEP,
    coloured,
    covariance,
    linear_plant,
    point_of,
    refit_at,
    response,
    sensitivity,
)
from scipy.stats import chi2, kstest

from identification.innovations.scoring.scores import score
from identification.kalman import noise_shares as module
from identification.kalman.noise_fit import evaluate_noise, fit_noise
from identification.kalman.noise_model import Noise, whiten
from identification.kalman.noise_shares import LEAST_SHARE, judge_shares, share_noise

LOUD = 2.4  # times the noise of the other sensor
SIGMA = 2e-3


def shared(*sizes):
    """Shares of the mean square 1, in the proportion of some sizes."""
    return tuple((np.array(sizes) / np.sqrt(np.mean(np.square(sizes)))).tolist())


def drawn(plant, noise, rng):
    """A residual of a plant with this noise, shape (N, ny)."""
    V = covariance(plant, noise)
    return SIGMA * (np.linalg.cholesky(V) @ rng.standard_normal(len(V))).reshape(-1, len(plant.C))


def test_the_slopes_of_the_likelihood_are_those_of_the_dense_gaussian():
    rng = np.random.default_rng(0)
    plant, noise = linear_plant(rng), Noise(0.7, 0.1, shared(1, LOUD))
    e = rng.standard_normal((40, 2))
    V, T = covariance(plant, noise), response(plant)
    x = np.linalg.solve(V, e.ravel())
    squares = e.ravel() @ x / 80

    def slope(part):
        return (x @ part @ x) / squares / np.trace(np.linalg.solve(V, part))

    of_inputs = T @ coloured(40, 2, Noise(1.0, 0.1)) @ T.T
    found = judge_shares(plant, noise, e, STEP)
    for i, share in enumerate(np.eye(2)):
        assert found.sensors[i] == pytest.approx(slope(np.diag(np.tile(share, 40))), rel=1e-9)
    assert found.inputs == pytest.approx(slope(of_inputs), rel=1e-9)
    dense = -0.5 * (80 * np.log(squares) + np.linalg.slogdet(V)[1])
    assert found.log_likelihood == pytest.approx(dense, rel=1e-9)


def test_the_power_of_one_half_raises_the_likelihood_from_anywhere(monkeypatch):
    """Zhou, Hu, Zhou and Lange (2019): the step minimises a bound that touches the criterion."""
    monkeypatch.setattr(module, "POWERS", (0.5,))
    monkeypatch.setattr(module, "MAX_STEPS", 1)
    monkeypatch.setattr(module, "LEAST_SHARE", 0.0)
    rng = np.random.default_rng(1)
    for _ in range(20):
        plant = linear_plant(rng)
        e = rng.standard_normal((40, 2)) * np.exp(rng.standard_normal(2))
        outputs = shared(*np.exp(rng.standard_normal(2)))
        begin = Noise(float(np.exp(rng.normal(0, 2))), 0.1, outputs)
        before = judge_shares(plant, begin, e, STEP).log_likelihood
        after = share_noise(plant, begin, e, STEP)
        assert after.log_likelihood > before
        assert after.noise != begin


def test_unequal_sensors_are_recovered_within_their_std():
    """Of N white samples log σ has the std 1/√(2N); input errors and columns take a few of them."""
    truth, N, z = Noise(0.3, 0.1, shared(1, LOUD)), 150, []
    for seed in range(24):
        rng = np.random.default_rng(seed)
        plant = linear_plant(rng, N, nx=2, nu=1)
        J = rng.standard_normal((N, 2, 3))
        found = fit_noise(plant, drawn(plant, truth, rng), J, np.zeros(3), STEP)
        ratio = found.of_outputs(2)[1] / found.of_outputs(2)[0] / LOUD
        z.append(np.log(ratio) * np.sqrt(N))  # of a ratio of two
    assert abs(np.mean(z)) < 3 / np.sqrt(24)
    assert 0.7 < np.std(z) < 1.6


def test_shares_are_never_less_likely_than_none():
    rng = np.random.default_rng(3)
    for noise in (Noise(0.4, 0.1, shared(1, LOUD)), Noise(0.0, 0.1, shared(3, 1)), Noise(0.4, 0.1)):
        plant = linear_plant(rng)
        e, J, prior = drawn(plant, noise, rng), rng.standard_normal((40, 2, 3)), np.zeros(3)
        found = fit_noise(plant, e, J, prior, STEP)
        alike = Noise(found.noise.ratio, found.noise.time)
        without = evaluate_noise(whiten(plant, J, alike, STEP), e, prior)
        assert found.log_likelihood >= without.log_likelihood
        assert np.mean(found.noise.of_outputs(2) ** 2) == pytest.approx(1)


def test_a_sensor_at_rest_is_not_one_without_noise():
    rng = np.random.default_rng(4)
    plant = linear_plant(rng, ny=3)
    e = rng.standard_normal((40, 3)) * [1.0, 0.0, 1e-4]
    alike = share_noise(plant, Noise(0.0, 0.1), e, STEP).noise.of_outputs(3)
    assert alike[1] == alike[2] == pytest.approx(LEAST_SHARE, rel=0.01)
    other = share_noise(plant, Noise(0.0, 0.1), e, STEP, ("m", "m", "rad")).noise.of_outputs(3)
    assert other[2] / other[0] == pytest.approx(1e-4, rel=0.3)  # of another unit


def gain(rng, equal):
    """Gain of a candidate that is felt by the quiet sensor, where nothing is missing."""
    truth = Noise(0.0, 0.1, shared(1, LOUD))
    plant = linear_plant(rng, 60)
    J, S = rng.standard_normal((60, 2, 2)), rng.standard_normal((60, 2, 1))
    S[:, 1] *= 0.1
    e = drawn(plant, truth, rng)
    level = fit_noise(plant, e, J, np.zeros(2), STEP, fine=not equal, levels=(0.0,))
    fit = refit_at(point_of(plant, e, J), level, np.zeros(2))
    return score(fit, [sensitivity(S)], OPTIONS)[0].gain


def test_gains_follow_their_law_beside_a_noisy_sensor_and_not_with_one_noise_for_both():
    """Twice the log likelihood of a size that is zero is χ² of one degree (Wilks 1938)."""
    rng = np.random.default_rng(5)
    found = [gain(rng, equal=False) for _ in range(150)]
    assert kstest(found, chi2(1).cdf).pvalue > 0.01
    assert kstest([gain(rng, equal=True) for _ in range(60)], chi2(1).cdf).pvalue < 1e-4
