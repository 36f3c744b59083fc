"""The Kalman predictor whitens as the dense covariance of its noise model does."""

import numpy as np
import pytest
from discovery_cases import STEP, covariance, linear_plant

from identification.kalman.noise_model import Noise, build_whitener


@pytest.mark.parametrize(("seed", "ratio", "time"), [(1, 0.3, 0.05), (2, 2.0, 0.2), (3, 0.01, 1.0)])
def test_determinant_and_quadratic_form_are_those_of_the_dense_gaussian(seed, ratio, time):
    rng = np.random.default_rng(seed)
    plant, noise = linear_plant(rng), Noise(ratio, time)
    e = rng.standard_normal((40, 2))
    V, filter_ = covariance(plant, noise), build_whitener(plant, noise, STEP)
    assert filter_.log_determinant == pytest.approx(np.linalg.slogdet(V)[1], rel=1e-9)
    E = filter_(e)
    assert np.sum(E**2) == pytest.approx(e.ravel() @ np.linalg.solve(V, e.ravel()), rel=1e-9)


def test_innovations_are_the_rows_of_the_inverse_cholesky_factor():
    """Sample by sample, so that a filter on a part of the log is a part of the filter."""
    rng = np.random.default_rng(4)
    plant, noise = linear_plant(rng), Noise(0.5, 0.1)
    e = rng.standard_normal((40, 2))
    factor = np.linalg.cholesky(covariance(plant, noise))
    dense = np.linalg.solve(factor, e.ravel()).reshape(e.shape)
    filter_ = build_whitener(plant, noise, STEP)
    np.testing.assert_allclose(filter_(e), dense, atol=1e-9)
    np.testing.assert_allclose(filter_(e[:15]), dense[:15], atol=1e-9)


def test_innovations_of_its_own_noise_are_white_and_of_unit_variance():
    rng = np.random.default_rng(5)
    plant, noise = linear_plant(rng), Noise(0.7, 0.1)
    drawn = np.linalg.cholesky(covariance(plant, noise)) @ rng.standard_normal((80, 2000))
    E = build_whitener(plant, noise, STEP)(drawn.reshape(40, 2, -1)).reshape(80, -1)
    # Entries of a covariance of 2000 draws have std 1/√2000 off and √(2/2000) on the diagonal.
    off = E @ E.T / 2000 - np.eye(80)
    assert np.abs(off).max() < 5 * np.sqrt(2 / 2000)


def test_without_input_noise_it_is_the_identity():
    rng = np.random.default_rng(6)
    filter_ = build_whitener(linear_plant(rng), Noise(0.0, 0.1), STEP)
    e = rng.standard_normal((40, 2, 3))
    np.testing.assert_array_equal(filter_(e), e)
    assert filter_.log_determinant == 0


def test_it_is_linear_and_treats_columns_alone():
    rng = np.random.default_rng(7)
    filter_ = build_whitener(linear_plant(rng), Noise(0.5, 0.1), STEP)
    a, b = rng.standard_normal((2, 40, 2))
    both = filter_(np.stack([a, 2 * a - 3 * b], axis=2))
    np.testing.assert_allclose(both[..., 0], filter_(a), atol=1e-12)
    np.testing.assert_allclose(both[..., 1], 2 * filter_(a) - 3 * filter_(b), atol=1e-9)


@pytest.mark.parametrize("ratio", [0.0, 0.5])
def test_the_transposed_filter_is_the_transpose(ratio):
    rng = np.random.default_rng(8)
    filter_ = build_whitener(linear_plant(rng), Noise(ratio, 0.1), STEP)
    every = np.eye(80).reshape(40, 2, 80)
    dense = filter_(every).reshape(80, 80)
    E = rng.standard_normal((40, 2))
    found = filter_.transposed(E).ravel()
    np.testing.assert_allclose(found, dense.T @ E.ravel(), atol=1e-9)
    part = filter_.transposed(E[:15]).ravel()
    np.testing.assert_allclose(part, dense[:30, :30].T @ E[:15].ravel(), atol=1e-9)
