"""Scores are what a dense generalised least squares gains by a column."""

import numpy as np
import pytest
from discovery_cases import covariance, linear_plant, point_of, scored, sensitivity
from scipy.stats import kstest

from identification.innovations.scoring.scores import RATIO_FACTORS
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise

N, NY, P = 60, 2, 3


def case(seed, ratio=0.0):
    rng = np.random.default_rng(seed)
    plant = linear_plant(rng, N)
    noise = Noise(ratio, 0.1)
    J, S = rng.standard_normal((N, NY, P)), rng.standard_normal((N, NY, 2))
    e = (np.linalg.cholesky(covariance(plant, noise)) @ rng.standard_normal(N * NY)).reshape(N, NY)
    return plant, noise, e + 0.3 * S[..., 0], J, S


def squares(V, e, F, ridge, below):
    """Least squares with covariance V and rows of the priors: sum of squares, coefficients."""
    factor = np.linalg.cholesky(V)
    rows = np.vstack([np.linalg.solve(factor, F), ridge])
    target = np.concatenate([np.linalg.solve(factor, e.ravel()), below])
    c = np.linalg.lstsq(rows, target, rcond=None)[0]
    return np.sum((target - rows @ c) ** 2), c, rows


@pytest.mark.parametrize(("seed", "ratio"), [(1, 0.0), (2, 0.5), (3, 3.0)])
def test_gain_size_and_std_are_those_of_brute_force(seed, ratio):
    plant, noise, e, J, S = case(seed, ratio)
    prior, sigma, mean = np.array([0.0, 2.0, 5.0]), 1.3, np.array([7.0, 0.4, -0.3])
    (s,) = scored(
        point_of(plant, e, J), NoiseLevel(noise, sigma, 0.0), prior, [sensitivity(S)], mean
    )
    n, F = N * NY, J.reshape(N * NY, P)
    G = np.hstack([F, S.reshape(n, 2)])
    ridge = np.hstack([np.diag(prior * sigma), np.zeros((P, 2))])
    best = {}
    for share in RATIO_FACTORS if ratio else (1.0,):
        V = covariance(plant, noise.scaled(share))
        det = np.linalg.slogdet(V)[1]
        for name, columns, rows in (("without", F, ridge[:, :P]), ("with", G, ridge)):
            found = squares(V, e, columns, rows, sigma * prior * mean)
            log_likelihood = -0.5 * (n * np.log(found[0] / n) + det)
            best.setdefault(name, []).append((log_likelihood, *found))
    without, with_it = (max(best[name], key=lambda b: b[0]) for name in ("without", "with"))
    assert s.gain == pytest.approx(2 * (with_it[0] - without[0]), rel=1e-8)
    np.testing.assert_allclose(s.size, with_it[2][P:], rtol=1e-8)
    H = np.linalg.inv(with_it[3].T @ with_it[3])[P:, P:]
    np.testing.assert_allclose(s.std, np.sqrt(np.diag(H) * with_it[1] / n), rtol=1e-8)
    assert s.level.sigma == pytest.approx(np.sqrt(with_it[1] / n), rel=1e-8)


def test_mixing_the_base_columns_and_scaling_the_effect_change_no_gain():
    plant, noise, e, J, S = case(4, 0.5)
    M = np.random.default_rng(0).standard_normal((P, P))
    level, free = NoiseLevel(noise, 1.0, 0.0), np.zeros(P)
    (one,) = scored(point_of(plant, e, J), level, free, [sensitivity(S)])
    (two,) = scored(point_of(plant, e, J @ M), level, free, [sensitivity(1e3 * S)])
    for name in ("gain", "p_value", "identifiable"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-6), name
    np.testing.assert_allclose(1e3 * two.size, one.size, rtol=1e-7)


def test_what_the_base_can_imitate_is_not_identifiable():
    plant, noise, e, J, _ = case(5, 0.5)
    S = (J @ np.array([1.0, -2.0, 0.5]))[..., None]
    level = NoiseLevel(noise, 1.0, 0.0)
    (s,) = scored(point_of(plant, e, J), level, np.zeros(P), [sensitivity(S)])
    assert s.identifiable < 1e-12
    (held,) = scored(point_of(plant, e, J), level, np.full(P, 1e6), [sensitivity(S)])
    assert held.identifiable > 0.99


def test_an_effect_of_the_wrong_sign_gains_nothing():
    plant, noise, e, J, S = case(6)
    S = S[..., :1]
    level = NoiseLevel(noise, 1.0, 0.0)
    right, wrong = (
        scored(point_of(plant, e, J), level, np.zeros(P), [sensitivity(S, sign)])[0]
        for sign in (1, -1)
    )
    assert right.size[0] > 0
    assert right.gain > 5
    assert wrong.gain == pytest.approx(0, abs=1e-9)
    assert wrong.p_value == 1


@pytest.mark.parametrize("ratio", [0.0, 1.0])
def test_chances_are_uniform_where_nothing_is_missing(ratio):
    """Effects enter as slow forces, as missing physics does, so that colour matters."""
    rng = np.random.default_rng(8)
    samples = 160
    plant = linear_plant(rng, samples)
    noise = Noise(ratio, 0.1)
    factor = np.linalg.cholesky(covariance(plant, noise))
    t = np.arange(samples)[:, None, None]
    J = np.cos(t * rng.uniform(0, 0.3, (NY, P)) + rng.uniform(0, 6, (NY, P)))
    S = np.cos(t * rng.uniform(0, 0.6, (NY, 12)) + rng.uniform(0, 6, (NY, 12)))
    six = [sensitivity(S[..., k : k + 2], name=f"e{k}") for k in range(0, 12, 2)]
    p = []
    for _ in range(40):
        e = (factor @ rng.standard_normal(samples * NY)).reshape(samples, NY)
        found = scored(point_of(plant, e, J), NoiseLevel(noise, 1.0, 0.0), np.zeros(P), six)
        p += [s.p_value for s in found]
    assert kstest(p, "uniform").pvalue > 0.01
