"""The error of a free run on unseen samples is as large as noise and the std of the values make."""

import numpy as np
from discovery_cases import record, slider, task, wander
from test_robot_change import N, changing

from identification.discovery.findings.finding import FindingKind
from identification.innovations.fitted_model import fit_model
from identification.innovations.unexpected import expect_error, find_unexpected_error


def fitted(log):
    return fit_model(task(log), (), {}).validation


def ratio(seed, error):
    """The error of the free run over what is expected, where nothing is missing."""
    log = record(
        slider(mass=2.2, damping=2.7), N, seed=seed, error=wander(N, error, 0.1, seed=seed)
    )
    validation = fitted(log)
    return validation.rms("report") / expect_error(validation)


def test_where_nothing_is_missing_the_error_is_the_expected_one():
    each = np.array([ratio(seed, 0.05 * (seed % 2)) for seed in range(100, 108)])
    assert 0.7 < np.sqrt(np.mean(each**2)) < 1.3
    assert each.max() < 2


def test_without_the_std_of_the_values_and_the_inputs_errors_it_would_not_be():
    log = record(slider(mass=2.2, damping=2.7), N, seed=1, error=wander(N, 0.03, 0.1, seed=1))
    validation = fitted(log)
    noise = np.sqrt(np.mean(validation.noise**2))
    assert expect_error(validation) > 3 * noise


def test_a_robot_that_changes_is_told():
    (found,) = find_unexpected_error(fitted(changing(4.0)))
    assert found.kind is FindingKind.UNEXPECTED_ERROR
    assert found.evidence.ratio > 3
    assert find_unexpected_error(fitted(changing(2.7))) == ()
