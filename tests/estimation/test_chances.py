"""Chances are those of `scipy.stats`."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from identification import chances

X, M, P = st.floats(0, 1e3), st.integers(1, 60), st.floats(1e-12, 0.999)


@given(X, M, M)
def test_of_values_above(x, m, n):
    assert chances.chi2_above(x, m) == pytest.approx(stats.chi2.sf(x, m), rel=1e-9, abs=1e-300)
    assert chances.f_above(x, m, n) == pytest.approx(stats.f.sf(x, m, n), rel=1e-9, abs=1e-300)
    assert chances.f_above(-x, m, n) == 1
    for t in (x, -x):
        assert chances.student_above(t, m) == pytest.approx(stats.t.sf(t, m), rel=1e-9, abs=1e-300)
        assert chances.normal_above(t) == pytest.approx(stats.norm.sf(t), rel=1e-9, abs=1e-300)


@given(P, M)
def test_of_levels(p, m):
    assert chances.chi2_level(p, m) == pytest.approx(stats.chi2.isf(p, m), rel=1e-9)
    assert chances.normal_level(p) == pytest.approx(stats.norm.isf(p), rel=1e-9, abs=1e-12)


@given(st.integers(0, 2**32 - 1), st.integers(2, 20), st.integers(2, 20))
def test_of_means(seed, n, m):
    rng = np.random.default_rng(seed)
    x, other = rng.normal(0.3, 1, n), rng.normal(0, 2, m)
    one = stats.ttest_1samp(x, 0.0, alternative="greater")
    assert chances.mean_above_zero(x) == pytest.approx((one.statistic, one.pvalue), rel=1e-9)
    two = stats.ttest_ind(x, other, equal_var=False, alternative="greater")
    assert chances.mean_above_other(x, other) == pytest.approx(two.pvalue, rel=1e-9)


def test_where_nothing_scatters_no_chance_is_told():
    assert np.isnan(chances.mean_above_other(np.ones(3), np.ones(4)))
