"""The compiled recursions give what the same equations give in numpy, sample by sample."""

import numpy as np
import pytest
from discovery_cases import STEP, linear_plant

from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, augment, build_whitener
from identification.kalman.recursion import COLUMNS_PER_CALL, filter_gains, propagate


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


@pytest.mark.parametrize("threads", ["1", "2"])
@pytest.mark.parametrize("columns", [1, 7, 2 * COLUMNS_PER_CALL + 3])
def test_all_columns_are_filtered_however_they_are_divided(threads, columns, monkeypatch):
    monkeypatch.setenv("INCA_MJ_THREADS", threads)
    rng = np.random.default_rng(2)
    filter_ = build_whitener(two_records(rng), Noise(0.7, 0.1), STEP)
    e = rng.standard_normal((40, 2, columns))
    z, slow = np.zeros((filter_.A.shape[1], columns)), []
    for k in range(40):
        new = e[k] - filter_.C @ z
        slow.append(filter_.L[k] @ new)
        z = filter_.A[k] @ (z + filter_.K[k] @ new) if k < 39 else z
    np.testing.assert_allclose(filter_(e), slow, atol=1e-10)
