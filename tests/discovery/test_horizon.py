"""Over a horizon: what input errors do there, and the verdict on an axis whose free run drifts."""

import numpy as np
import pytest
from discovery_cases import OPTIONS, STEP, coloured, linear_plant, record, response, slider, wander

from identification import InputError
from identification.discovery.disturbance import propagate_over_windows
from identification.discovery.nominal_model import NominalModel, fit_with_effects
from identification.discovery.proof import validate
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_model import Noise, build_whitener

FREE, KNOWN = ("mass", "damping"), np.array([0.3, 0.3])


def test_what_input_errors_do_in_a_window_is_what_the_dense_covariance_says():
    plant, noise, L = linear_plant(np.random.default_rng(5), nx=3), Noise(0.4, 0.05), 12
    filter_ = build_whitener(plant, noise, STEP)
    starts = np.array([0, 12, 24])
    found = propagate_over_windows(filter_, noise.ratio, 2, starts, L)
    for k, value in zip(starts, found, strict=True):
        part = LinearPlant(plant.A[k : k + L - 1], plant.B[k : k + L - 1], plant.C)
        x, X = np.eye(3), [plant.C]
        for A in part.A:
            x = A @ x
            X.append(plant.C @ x)
        X, G = np.concatenate(X), response(part)
        left = (np.eye(len(X)) - X @ np.linalg.pinv(X)) @ G
        dense = np.trace(left @ coloured(L, 2, noise) @ left.T) / len(X)
        assert value == pytest.approx(dense, rel=1e-9)


@pytest.fixture(scope="module")
def fitted():
    log = record(slider(mass=2.2), 500, seed=2, error=wander(500, 0.1, 0.1, seed=3))
    return fit_with_effects(
        NominalModel(slider(), FREE, KNOWN), log.part("estimation"), (), {}, OPTIONS
    ), log


def test_errors_over_a_horizon_are_less_than_those_of_a_free_run_that_drifts(fitted):
    fit, log = fitted
    free, near = validate(fit, log), validate(fit, log, 0.4)
    assert near.judged.shape == near.measured.shape == (240, 1)
    assert near.rms < 0.5 * free.rms
    assert near.disturbance < 0.5 * free.disturbance
    assert near.rms == pytest.approx(np.hypot(fit.level.sigma, near.disturbance), rel=0.3)
    np.testing.assert_array_equal(near.innovations, free.innovations)
    assert near.gap.fit_percent[0] > free.gap.fit_percent[0]


def test_a_horizon_longer_than_what_is_unseen_is_refused(fitted):
    with pytest.raises(InputError, match="begins in the unseen"):
        validate(*fitted, 6.0)
