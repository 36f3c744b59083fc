"""What is kept is what would be computed again, and what is solved by products what QR solves."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import STEP, linear_plant, point_of

from identification.estimation.priors import Priors
from identification.kalman import problem as module
from identification.kalman.noise_fit import NoiseLevel, evaluate_noise, fit_noise
from identification.kalman.noise_model import Noise, Whitened, build_whitener, whiten
from identification.kalman.problem import linearise_criterion


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


def test_other_columns_another_plant_and_another_noise_are_whitened_anew():
    plant, e, J = case()
    level = fit_noise(plant, e, J, np.zeros(3), STEP, fine=False)
    known = whiten(plant, J, level.noise, STEP)
    for other in (
        whiten(plant, J.copy(), level.noise, STEP),
        whiten(replace(plant, C=-plant.C), J, level.noise, STEP),
        whiten(plant, J, Noise(0.123, 0.1), STEP),
    ):
        assert other is not known
        fresh = build_whitener(other.plant, other.noise, STEP)(other.J)
        np.testing.assert_array_equal(other.F, fresh.reshape(80, 3))


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
