"""The Kalman predictor whitens as the dense covariance of its noise model does."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import STEP, covariance, linear_plant, point_of

from identification.estimation.priors import Priors
from identification.kalman import problem as module
from identification.kalman.backwards import information, transpose_filter
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_fit import NoiseLevel, evaluate_noise, fit_noise
from identification.kalman.noise_model import Noise, Whitened, augment, build_whitener, whiten
from identification.kalman.problem import linearise_criterion
from identification.kalman.recursion import COLUMNS_PER_CALL, propagate

SHARES = (1.2, 0.75)  # of two outputs


def two_records(rng):
    """A plant of two records of 20 samples: nothing passes from one to the next."""
    plant = linear_plant(rng)
    A, B = plant.A.copy(), plant.B.copy()
    A[19] = B[19] = 0
    return LinearPlant(A, B, plant.C)


def whole(plant, noise):
    """The dense covariance, of which what lies between two records is zero."""
    V = covariance(plant, noise)
    if not plant.A[19].any():
        V[:40, 40:] = V[40:, :40] = 0
    return V


@pytest.mark.parametrize("made", [linear_plant, two_records])
@pytest.mark.parametrize(
    "noise",
    [Noise(0.3, 0.05), Noise(2.0, 0.2), Noise(0.01, 1.0), Noise(0.7, 0.1, SHARES),
     Noise(0.0, 0.1, SHARES), Noise(0.0, 0.1)],
)  # fmt: skip
def test_innovations_are_the_rows_of_the_inverse_cholesky_factor(noise, made):
    """Sample by sample, so that a filter on a part of the log is a part of the filter."""
    rng = np.random.default_rng(4)
    plant, e = made(rng), rng.standard_normal((40, 2, 3))
    factor, filter_ = np.linalg.cholesky(whole(plant, noise)), build_whitener(plant, noise, STEP)
    dense = np.linalg.solve(factor, e.reshape(80, 3)).reshape(e.shape)
    np.testing.assert_allclose(filter_(e), dense, atol=1e-9)
    np.testing.assert_allclose(filter_(e[:15]), dense[:15], atol=1e-9)
    expected = 2 * np.sum(np.log(np.diag(factor)))
    assert filter_.log_determinant == pytest.approx(expected, rel=1e-9, abs=1e-9)


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


def dense_steps(system):
    """The transitions of the whole state (x, w), and the covariance of what is new in each."""
    (nx, nu, _), last = system.sizes, np.diag(np.repeat([0.0, 1.0], system.sizes[:2]))
    for A, B, a in zip(system.A, system.B, system.a, strict=True):
        step = np.block([[A, B], [np.zeros((nu, nx)), a * np.eye(nu)]])
        yield step, (1 - a**2) * last * np.concatenate([np.zeros(nx), system.variances])


@pytest.fixture
def system():
    return augment(two_records(np.random.default_rng(1)), Noise(0.7, 0.1), STEP)


def test_variances_are_those_of_the_equations(system):
    (nx, nu, _) = system.sizes
    C = np.hstack([system.C, np.zeros((len(system.C), nu))])
    P = np.diag(np.concatenate([np.zeros(nx), system.variances]))
    for (step, new), found in zip(dense_steps(system), propagate(system), strict=True):
        P = step @ P @ step.T + new
        np.testing.assert_allclose(found, np.diag(C @ P @ C.T), rtol=1e-12)


def test_information_is_that_of_the_dense_covariance(system):
    """The diagonal of the inverse covariance of all residuals; N that of the transposed filter."""
    plant, noise = two_records(np.random.default_rng(1)), Noise(0.7, 0.1)
    filter_ = build_whitener(plant, noise, STEP)
    V, N = information(system, filter_.K, filter_.L)
    inverse = np.linalg.inv(whole(plant, noise))
    np.testing.assert_allclose(V.ravel(), np.diag(inverse), rtol=1e-8)
    every = [transpose_filter(system, filter_.K, filter_.L, E)[1]
             for E in np.eye(80).reshape(80, 40, 2)]  # fmt: skip
    np.testing.assert_allclose(N, np.sum(np.square(every), axis=0), rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("columns", [1, 2 * COLUMNS_PER_CALL + 3])
def test_all_columns_are_filtered_however_they_are_divided(columns, monkeypatch):
    monkeypatch.setenv("INCA_MJ_THREADS", "2")
    rng = np.random.default_rng(2)
    filter_ = build_whitener(two_records(rng), Noise(0.7, 0.1), STEP)
    system, e = filter_.system, rng.standard_normal((40, 2, columns))
    nx, nu, _ = system.sizes
    steps, z, slow = [*dense_steps(system)], np.zeros((nx + nu, columns)), []
    for k in range(40):
        new = e[k] - system.C @ z[:nx]
        slow.append(filter_.L[k] @ new)
        z = steps[k][0] @ (z + filter_.K[k] @ new) if k < 39 else z
    np.testing.assert_allclose(filter_(e), slow, atol=1e-10)


def test_samples_that_are_far_apart_are_of_one_record():
    """Nothing is left of an input's error after a sample, and the plant still remembers."""
    rng = np.random.default_rng(5)
    plant, noise, e = linear_plant(rng), Noise(0.7, 1e-5), rng.standard_normal((40, 2, 1))
    filter_ = build_whitener(plant, noise, STEP)
    assert filter_.system.records == ((0, 40),)
    factor = np.linalg.cholesky(covariance(plant, noise))
    dense = np.linalg.solve(factor, e.reshape(80, 1)).reshape(e.shape)
    np.testing.assert_allclose(filter_(e), dense, atol=1e-9)
