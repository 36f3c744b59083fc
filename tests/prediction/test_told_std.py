"""A std of few windows is not told, and the degrees of freedom are those of known cases."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2

from identification.prediction.told_std import MIN_FREEDOM, degrees_of_freedom, told_std


def fitted(S, weight):
    """A fit of windows whose sensitivities are S (W, m, p), with a std of one of each value."""
    free = SimpleNamespace(on_bound=lambda q: np.zeros(len(q), bool))
    prior = SimpleNamespace(weight=np.asarray(weight, float), space=free)
    return SimpleNamespace(
        q=np.zeros(len(weight)),
        tangents=[
            SimpleNamespace(projected=(s, None)) for s in (S if isinstance(S, list) else [S])
        ],
        problem=SimpleNamespace(prior=prior),
        std=np.ones(len(weight)),
    )


def test_equal_windows_have_one_degree_less_than_there_are():
    found = fitted(np.tile(np.eye(2), (7, 1, 1)), [0, 0])
    assert degrees_of_freedom(found) == pytest.approx([6, 6])
    assert told_std(found).tolist() == [1, 1]


def test_windows_of_records_may_differ_in_length():
    long, short = np.zeros((4, 5, 2)), np.tile(np.eye(2), (3, 1, 1))
    long[:, :2] = np.eye(2)  # what else they have tells nothing
    found = fitted([long, short], [0, 0])
    assert degrees_of_freedom(found) == pytest.approx([6, 6])


def test_one_window_tells_no_std_however_many_others_feel_another_parameter():
    S = np.zeros((9, 2, 2))
    S[:, 0, 0] = 1.0
    S[4, 1, 1] = 1.0
    found = fitted(S, [0, 0])
    assert degrees_of_freedom(found) == pytest.approx([8, 0])
    assert np.isnan(told_std(found)).tolist() == [False, True]


def test_a_std_that_is_that_of_the_prior_is_known():
    found = fitted(1e-3 * np.tile(np.eye(1), (2, 1, 1)), [1.0])
    assert told_std(found).tolist() == [1]


def test_the_fewest_degrees_of_freedom_make_a_std_right_within_a_factor_of_four():
    low, high = (MIN_FREEDOM / chi2.ppf([0.975, 0.025], MIN_FREEDOM)) ** 0.5
    assert 1 / 4 < low < high < 4
