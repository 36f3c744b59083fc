"""The Kalman predictor whitens as the dense covariance of its noise model does."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import STEP, covariance, linear_plant, point_of

from identification.estimation.priors import Priors
from identification.kalman import problem as module
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_fit import NoiseLevel, evaluate_noise, fit_noise
from identification.kalman.noise_model import Noise, Whitened, augment, build_whitener, whiten
from identification.kalman.problem import linearise_criterion
from identification.kalman.recursion import COLUMNS_PER_CALL, filter_gains, propagate

SHARES = (1.2, 0.75)  # of two outputs


@pytest.mark.parametrize(
    "noise",
    [Noise(0.3, 0.05), Noise(2.0, 0.2), Noise(0.01, 1.0), Noise(0.7, 0.1, SHARES),
     Noise(0.0, 0.1, SHARES)],
)  # fmt: skip
def test_determinant_and_quadratic_form_are_those_of_the_dense_gaussian(noise):
    rng = np.random.default_rng(1)
    plant = linear_plant(rng)
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
    filter_ = build_whitener(linear_plant(rng), Noise(ratio, 0.1, SHARES), STEP)
    every = np.eye(80).reshape(40, 2, 80)
    dense = filter_(every).reshape(80, 80)
    E = rng.standard_normal((40, 2))
    found = filter_.transposed(E).ravel()
    np.testing.assert_allclose(found, dense.T @ E.ravel(), atol=1e-9)
    part = filter_.transposed(E[:15]).ravel()
    np.testing.assert_allclose(part, dense[:30, :30].T @ E[:15].ravel(), atol=1e-9)


def case(seed=1):
    rng = np.random.default_rng(seed)
    e, J = rng.standard_normal((40, 2)), rng.standard_normal((40, 2, 3))
    return linear_plant(rng), e, J


@pytest.mark.parametrize("fine", [False, True])
def test_the_noise_that_is_found_has_been_whitened_with(fine, monkeypatch):
    plant, e, J = case()
    prior = np.array([0.0, 1.0, 2.0])
    level = fit_noise(plant, e, J, prior, STEP, fine=fine)
    filter_ = build_whitener(plant, level.noise, STEP)
    fresh = Whitened(plant, J, level.noise, filter_, filter_(J).reshape(80, 3))
    assert level == evaluate_noise(fresh, e, prior)
    found = whiten(plant, J, level.noise, STEP)
    assert found is whiten(plant, J, level.noise, STEP)
    np.testing.assert_array_equal(found.F, found.filter(J).reshape(80, 3))
    np.testing.assert_array_equal(found.H, found.F.T @ found.F)


@pytest.mark.parametrize("damping", [0.0, 0.3])
@pytest.mark.parametrize("alike", [0.0, 1.0 - 1e-9, 1.0])
def test_a_step_by_products_is_that_of_the_columns(damping, alike, monkeypatch):
    """Also where two columns are nearly or fully alike: then QR takes over."""
    plant, e, J = case(2)
    J[..., 1] = alike * J[..., 0] + (1 - alike) * J[..., 1]
    level = NoiseLevel(Noise(0.5, 0.1), 1.3, 0.0)
    point = point_of(plant, e, J)
    priors = Priors(point.space, np.ones(3), np.array([0.0, 0.0, 3.0]))
    task = linearise_criterion(point, level, priors)
    np.testing.assert_allclose(task.curvature, task.rows.T @ task.rows, rtol=1e-12)
    quick = task.step(damping)
    monkeypatch.setattr(module, "MAX_CONDITION", 0.0)
    slow = replace(task).step(damping)
    fall = task.expected_fall(slow)
    assert task.expected_fall(quick) == pytest.approx(fall, rel=1e-9)
    if alike < 0.5:
        np.testing.assert_allclose(quick, slow, rtol=1e-9)


def two_records(rng):
    """A plant of two records of 20 samples: nothing passes from one to the next."""
    plant = linear_plant(rng)
    A, B = plant.A.copy(), plant.B.copy()
    A[19] = B[19] = 0
    return LinearPlant(A, B, plant.C)


@pytest.fixture
def system():
    return augment(two_records(np.random.default_rng(1)), Noise(0.7, 0.1), STEP)


def test_gains_are_those_of_the_equations(system):
    A, C, P, share = system
    K, L, log_determinant = filter_gains(*system)
    first, total = P, 0.0
    for k in range(len(A) + 1):
        S = C @ P @ C.T + np.eye(len(C))
        total += np.linalg.slogdet(S)[1]
        np.testing.assert_allclose(L[k] @ S @ L[k].T, np.eye(len(C)), atol=1e-12)
        np.testing.assert_allclose(K[k], P @ C.T @ np.linalg.inv(S), atol=1e-9)
        if k < len(A):
            P = A[k] @ (P - K[k] @ S @ K[k].T) @ A[k].T + share[k] * first
    assert log_determinant == pytest.approx(total, rel=1e-12)


def test_variances_are_those_of_the_equations(system):
    A, C, P, share = system
    first = P
    for step, fresh, found in zip(A, share, propagate(*system), strict=True):
        P = step @ P @ step.T + fresh * first
        np.testing.assert_allclose(found, np.diag(C @ P @ C.T), rtol=1e-12)


@pytest.mark.parametrize("columns", [1, 2 * COLUMNS_PER_CALL + 3])
def test_all_columns_are_filtered_however_they_are_divided(columns, monkeypatch):
    monkeypatch.setenv("INCA_MJ_THREADS", "2")
    rng = np.random.default_rng(2)
    filter_ = build_whitener(two_records(rng), Noise(0.7, 0.1), STEP)
    e = rng.standard_normal((40, 2, columns))
    z, slow = np.zeros((filter_.A.shape[1], columns)), []
    for k in range(40):
        new = e[k] - filter_.C @ z
        slow.append(filter_.L[k] @ new)
        z = filter_.A[k] @ (z + filter_.K[k] @ new) if k < 39 else z
    np.testing.assert_allclose(filter_(e), slow, atol=1e-10)
