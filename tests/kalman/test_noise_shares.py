"""How noise is shared out: each sensor's σ and each input's ρ are found, and scores need them."""

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

from identification.estimation.residuals import innovation_tests
from identification.innovations.scoring.scores import score
from identification.kalman import noise_shares as module
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_fit import evaluate_noise, fit_noise
from identification.kalman.noise_model import Noise, build_whitener, whiten
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
    plant, noise = linear_plant(rng), Noise(0.7, 0.1, shared(1, LOUD), shared(1, 3))
    e = rng.standard_normal((40, 2))
    V, T = covariance(plant, noise), response(plant)
    x = np.linalg.solve(V, e.ravel())
    squares = e.ravel() @ x / 80

    def slope(part):
        return (x @ part @ x) / squares / np.trace(np.linalg.solve(V, part))

    one = [Noise(1.0, 0.1, (), tuple(np.sqrt(share))) for share in np.eye(2)]
    of_inputs = [T @ coloured(40, 2, n) @ T.T for n in one]
    found = judge_shares(plant, noise, e, STEP)
    for i, share in enumerate(np.eye(2)):
        assert found.sensors[i] == pytest.approx(slope(np.diag(np.tile(share, 40))), rel=1e-9)
        assert found.inputs[i] == pytest.approx(slope(of_inputs[i]), rel=1e-9)
    together = sum(s**2 * part for s, part in zip(noise.inputs, of_inputs, strict=True))
    assert found.input == pytest.approx(slope(together), rel=1e-9)
    dense = -0.5 * (80 * np.log(squares) + np.linalg.slogdet(V)[1])
    assert found.log_likelihood == pytest.approx(dense, rel=1e-9)


@pytest.mark.parametrize("each_input", [False, True])
def test_the_power_of_one_half_raises_the_likelihood_from_anywhere(each_input, monkeypatch):
    """Zhou, Hu, Zhou and Lange (2019): the step minimises a bound that touches the criterion."""
    monkeypatch.setattr(module, "POWERS", (0.5,))
    monkeypatch.setattr(module, "MAX_STEPS", 1)
    monkeypatch.setattr(module, "LEAST_SHARE", 0.0)
    rng = np.random.default_rng(1)
    for _ in range(20):
        plant = linear_plant(rng)
        e = rng.standard_normal((40, 2)) * np.exp(rng.standard_normal(2))
        outputs, inputs = (shared(*np.exp(rng.standard_normal(2))) for _ in range(2))
        begin = Noise(float(np.exp(rng.normal(0, 2))), 0.1, outputs, inputs if each_input else ())
        before = judge_shares(plant, begin, e, STEP).log_likelihood
        after = share_noise(plant, begin, e, STEP, each_input=each_input)
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


def coupled(rng, samples=200):
    """Three carts, each with a force and a sensor of its own."""
    A = np.kron(np.eye(3), [[1, STEP], [0, 0.9]])
    B = np.kron(np.eye(3), [[STEP**2 / 2], [STEP]])
    every = (np.tile(M, (samples - 1, 1, 1)) for M in (A, B))
    return LinearPlant(*every, np.kron(np.eye(3), [[1.0, 0.0]]))


@pytest.mark.parametrize(("sizes", "are_told"), [((1, 1, 8), True), ((1, 1, 1), False)])
def test_inputs_have_shares_of_their_own_where_the_data_ask_for_them(sizes, are_told):
    ratios, white = [], []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        plant = coupled(rng)
        e = drawn(plant, Noise(60.0, 0.05, (), shared(*sizes)), rng)
        found = fit_noise(
            plant, e, rng.standard_normal((200, 3, 2)), np.zeros(2), STEP, each_input=True
        )
        assert bool(found.noise.inputs) is are_told
        each = found.noise.of_inputs(3)
        ratios.append(np.log(each[2] / np.sqrt(np.mean(each[:2] ** 2))))
        E = build_whitener(plant, found.noise, STEP)(e)
        white.append(innovation_tests(E, STEP).p_correlation)
    assert np.median(ratios) == pytest.approx(np.log(sizes[2]), abs=0.6)
    assert min(white) > 1e-4  # with one ρ for all, a third of such logs is not white


def test_a_calmed_noise_is_no_larger_anywhere_and_of_no_input_above_the_median():
    noise = Noise(2.0, 0.1, (), shared(1, 1.2, 9))
    calm = noise.calmed().of_inputs(3)
    np.testing.assert_allclose(calm, np.minimum(noise.of_inputs(3), noise.of_inputs(3)[1]))
    assert np.mean(np.square(noise.calmed().inputs)) == pytest.approx(1)


def test_what_is_missing_at_one_input_gains_as_much_as_with_one_error_for_all():
    """Its input is taken for one that errs by more; its candidate is scored without that."""
    rng = np.random.default_rng(9)
    plant = coupled(rng)
    push = np.zeros((200, 3))
    push[:, 0] = np.sign(np.sin(np.arange(200) / 9))
    S = (response(plant) @ push.ravel()).reshape(200, 3)
    e = drawn(plant, Noise(10.0, 0.05), rng) + 100 * SIGMA * S
    J, gains = rng.standard_normal((200, 3, 2)), []
    found = fit_noise(plant, e, J, np.zeros(2), STEP, each_input=True)
    assert found.noise.inputs
    alike = fit_noise(plant, e, J, np.zeros(2), STEP, fine=False)
    for level in (found, alike):
        fit = refit_at(point_of(plant, e, J), level, np.zeros(2))
        gains.append(score(fit, [sensitivity(S[..., None])], OPTIONS)[0].gain)
    assert gains[0] > 0.4 * gains[1] > 20


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
