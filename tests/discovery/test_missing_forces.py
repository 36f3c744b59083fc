"""Missing forces: the smoother against dense algebra, and forces whose truth is known."""

import numpy as np
import pytest
from discovery_cases import (
    FREE,
    KNOWN,
    OPTIONS,
    STEP,
    coloured,
    covariance,
    linear_plant,
    record,
    response,
    slider,
)

from identification.discovery.missing_forces import estimate_missing_forces
from identification.discovery.nominal_model import NominalModel, fit_with_effects
from identification.kalman.noise_model import Noise, smooth


@pytest.mark.parametrize("seed", range(4))
def test_the_smoother_is_the_conditional_mean(seed):
    rng = np.random.default_rng(seed)
    plant, noise = linear_plant(rng), Noise(0.7, 0.05)
    n, ny = len(plant.B) + 1, len(plant.C)
    e = rng.standard_normal((n, ny))
    T, W = response(plant), coloured(n, plant.B.shape[2], noise)
    dense = W @ T.T @ np.linalg.solve(covariance(plant, noise), e.ravel())
    w, part = smooth(plant, noise, e, STEP)
    np.testing.assert_allclose(w.ravel(), dense, atol=1e-8)
    np.testing.assert_allclose(part.ravel(), T @ dense, atol=1e-8)


def test_without_noise_of_the_inputs_nothing_is_missing():
    rng = np.random.default_rng(0)
    plant = linear_plant(rng)
    e = rng.standard_normal((len(plant.B) + 1, len(plant.C)))
    w, part = smooth(plant, Noise(0.0, 1.0), e, STEP)
    assert not w.any()
    assert not part.any()


def test_a_force_that_the_model_lacks_is_seen_in_newtons():
    n = 500
    push = 0.4 * np.sin(2 * np.pi * 0.7 * STEP * np.arange(n))[:, None]  # of 5 N per unit
    log = record(slider(), n, error=push)
    fit = fit_with_effects(NominalModel(slider(), FREE, KNOWN / 100), log, (), {}, OPTIONS)
    (missing,) = estimate_missing_forces(fit)
    assert missing.where == "the actuated joints"
    assert missing.names == ("slide",)
    assert missing.units == ("N",)
    assert missing.share > 0.99
    inner = slice(50, -50)
    assert np.corrcoef(missing.force[inner, 0], push[inner, 0])[0, 1] > 0.95
    slope = missing.force[inner, 0] @ push[inner, 0] / (push[inner, 0] @ push[inner, 0])
    assert slope == pytest.approx(5.0, rel=0.1)
