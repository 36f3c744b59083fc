"""The error of a free run on unseen samples is as large as noise and the std of the values make."""

from functools import cache

import numpy as np
import pytest
from discovery_cases import OPTIONS, record, slider, task, wander
from test_robot_change import N, changing

from identification.discovery.findings.finding import FindingKind
from identification.innovations.fitted_model import fit_model
from identification.innovations.unexpected import chance_of, draw_squares, find_unexpected_error


@cache
def fitted(seed, error=0.0):
    """A fit where nothing is missing."""
    log = record(
        slider(mass=2.2, damping=2.7), N, seed=seed, error=wander(N, error, 0.1, seed=seed)
    )
    return fit_model(task(log), (), {}).validation


def square(validation):
    return float(np.mean(validation.e[validation.parts.report] ** 2))


@pytest.mark.parametrize("error", [0.0, 0.03])
def test_where_nothing_is_missing_the_error_is_the_expected_one(error):
    each = [fitted(seed, error) for seed in range(5)]
    chances = [chance_of(square(v), draw_squares(v)) for v in each]
    assert min(chances) > OPTIONS.structure_level
    assert max(chances) > 0.5
    assert all(find_unexpected_error(v, OPTIONS) == () for v in each)


def test_the_drawn_errors_are_those_that_the_covariances_say():
    v = fitted(1, 0.03)
    sensors = np.mean(v.noise**2)
    inputs = np.mean(v.refit.level.sigma**2 * v.moved[v.parts.report])
    draws = draw_squares(v)
    assert draws.mean() > sensors + 0.7 * inputs
    assert inputs > 3 * sensors  # so that errors without them would not do


def test_few_independent_errors_make_a_large_one_likely():
    """A slow error is as large as its std or three times that by luck, white noise never is."""
    rng = np.random.default_rng(2)
    slow, white = rng.chisquare(1, 4000), rng.chisquare(400, 4000) / 400
    assert chance_of(9.0, slow) == pytest.approx(2.7e-3, rel=0.5)
    assert chance_of(2.0, white) < 1e-20


def test_a_robot_that_changes_is_told():
    changed = fit_model(task(changing(4.0)), (), {}).validation
    (found,) = find_unexpected_error(changed, OPTIONS)
    assert found.kind is FindingKind.UNEXPECTED_ERROR
    assert found.evidence.ratio > 3
    same = fit_model(task(changing(2.7)), (), {}).validation
    assert find_unexpected_error(same, OPTIONS) == ()
