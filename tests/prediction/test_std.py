"""The std of fitted values: by blocks of windows, and where few windows tell them."""

import numpy as np
import pytest
from fit_of_errors import fit_of_errors
from scipy.stats import chi2

from identification.prediction.fits.std import (
    MIN_FREEDOM,
    degrees_of_freedom,
    is_told_by_few,
    told_std,
)


def fitted(windows, weight):
    """A fit of windows, each with a shape (L, p) in which it feels the values."""
    errors = np.random.default_rng(1).normal(size=(len(windows), len(windows[0]), 1))
    return fit_of_errors(errors, np.array(windows)[:, :, None, :], weight)


SLOW = np.linspace(0, 1, 20) ** 2
BOTH = np.stack([SLOW, np.cos(9 * SLOW)], axis=-1)


def test_equal_windows_have_one_degree_less_than_there_are():
    found = fitted([BOTH] * 7, [0, 0])
    assert degrees_of_freedom(found) == pytest.approx([6, 6])
    np.testing.assert_array_equal(told_std(found), found.std)


def test_one_window_tells_no_scatter_however_many_others_feel_another_parameter():
    one = [SLOW, 0 * SLOW]
    found = fitted([np.stack(x, axis=-1) for x in [one] * 8 + [[SLOW, SLOW]]], [0, 0])
    assert degrees_of_freedom(found)[1] < 1
    assert is_told_by_few(found).tolist() == [False, True]
    assert told_std(found)[0] == found.std[0]
    assert told_std(found)[1] > found.std[1]


def test_a_std_that_is_that_of_the_prior_is_known():
    found = fitted([1e-3 * BOTH] * 2, [1.0, 1.0])
    assert not is_told_by_few(found).any()
    np.testing.assert_allclose(told_std(found), 1.0, rtol=1e-3)


WINDOWS, SAMPLES = 20, 30
TIME = np.linspace(0.0, 1.0, SAMPLES)


def estimates(error, feeling, count=300):
    """Estimates of a value that is 0 and that some windows feel, and the fits that gave them."""
    rng = np.random.default_rng(7)
    level = np.stack([np.ones(SAMPLES), TIME])
    off = np.eye(SAMPLES) - np.linalg.pinv(level) @ level
    for _ in range(count):
        S = np.zeros((WINDOWS, SAMPLES))
        S[rng.choice(WINDOWS, feeling, replace=False)] = TIME**2
        e, s = error(rng), S @ off
        value = float(np.sum(s * e) / np.sum(s * s))
        yield value, fit_of_errors((e - S * value)[..., None], S[..., None, None])


def white(rng):
    return rng.standard_normal((WINDOWS, SAMPLES))


def forced(rng):
    return rng.standard_normal((WINDOWS, 1)) * TIME**2


@pytest.mark.parametrize("error", [white, forced])
@pytest.mark.parametrize("feeling", [1, 2, 3])
def test_the_std_of_what_few_windows_feel_covers_the_truth(error, feeling):
    """By blocks alone, that of one window is none at all."""
    each = [*estimates(error, feeling)]
    told = [abs(value) < 2 * told_std(fit)[0] for value, fit in each]
    by_blocks = [abs(value) < 2 * fit.std[0] for value, fit in each]
    assert np.mean(told) > 0.88
    assert np.mean(by_blocks) < (0.2 if feeling == 1 else 0.85)


def test_the_std_of_few_windows_is_no_wider_than_it_must_be():
    ratios = [told_std(fit)[0] for _, fit in estimates(white, 1)]
    level = np.stack([np.ones(SAMPLES), TIME])
    off = np.eye(SAMPLES) - np.linalg.pinv(level) @ level
    true = 1 / np.linalg.norm(off @ TIME**2)
    assert 0.9 < np.median(ratios) / true < 1.6


def test_the_fewest_degrees_of_freedom_make_a_std_right_within_a_factor_of_four():
    low, high = (MIN_FREEDOM / chi2.ppf([0.975, 0.025], MIN_FREEDOM)) ** 0.5
    assert 1 / 4 < low < high < 4
