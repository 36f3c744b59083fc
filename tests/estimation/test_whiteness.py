"""One test of whiteness: its statistic as in the book, its chances as often as they say."""

import numpy as np
import pytest
from scipy.stats import chi2, kstest

from identification.estimation.residuals import LAGS, autocorrelation, whiteness


def signal(seed, n=400, ny=3):
    return 2.0 + np.random.default_rng(seed).standard_normal((n, ny))


def test_the_statistic_is_the_one_of_ljung_and_box():
    """Sample by sample and lag by lag."""
    x = signal(0, 120, 2)
    for i, column in enumerate((x - x.mean(axis=0)).T):
        Q, n = 0.0, len(column)
        for k in range(1, LAGS + 1):
            r = sum(column[t] * column[t - k] for t in range(k, n)) / sum(column**2)
            Q += n * (n + 2) * r**2 / (n - k)
        found = whiteness(x)
        assert found.Q[i] == pytest.approx(Q, rel=1e-12)
        assert found.p_values[i] == pytest.approx(chi2.sf(Q, LAGS), rel=1e-9)
    assert found.p_value == pytest.approx(chi2.sf(found.Q.sum(), 2 * LAGS), rel=1e-12)


def test_chances_are_uniform_of_white_signals():
    found = [whiteness(signal(seed)) for seed in range(300)]
    assert kstest([p for w in found for p in w.p_values], "uniform").pvalue > 1e-3
    assert kstest([w.p_value for w in found], "uniform").pvalue > 1e-3


def test_neither_units_nor_a_constant_nor_the_order_of_channels_matter():
    x = signal(1)
    same = whiteness((x * [1e6, 1e-6, 1.0] + [0.0, 5.0, -3.0])[:, ::-1])
    np.testing.assert_allclose(same.Q[::-1], whiteness(x).Q, rtol=1e-6)
    assert same.p_value == pytest.approx(whiteness(x).p_value, rel=1e-6)


@pytest.mark.parametrize("n", [8, 40, 99, 100, 1000])
def test_there_are_no_more_lags_than_a_quarter_of_the_samples(n):
    assert len(whiteness(signal(2, n)).r) == min(LAGS, n // 4)


def test_one_channel_that_is_not_white_shows_in_its_own_chance_and_in_that_of_all():
    x = signal(3)
    x[1:, 1] += 0.9 * (x[:-1, 1] - 2.0)
    found = whiteness(x)
    assert found.p_values[1] < 1e-4
    assert found.p_values[[0, 2]].min() > 1e-3
    assert found.p_value < 1e-4


def test_a_silent_signal_is_not_called_coloured():
    found = whiteness(np.zeros((100, 2)))
    assert (found.p_values == 1).all()
    assert found.predictable == 0
    np.testing.assert_array_equal(autocorrelation(np.ones((9, 1)), 2), np.zeros((3, 1)))
