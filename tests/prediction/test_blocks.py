"""Gains of blocks: what one model predicts better than another."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.prediction.scoring.first_fit import THIN, picks
from identification.windows.blocks import MAX_BLOCKS_PER_RECORD, block_gains, count_blocks
from identification.windows.problem import MIN_WINDOWS

lengths = st.lists(st.integers(2, 90), min_size=1, max_size=3)


def squares(lengths, seed):
    """Mean squares of windows of some records."""
    rng = np.random.default_rng(seed)
    return [rng.chisquare(3, n) for n in lengths]


@given(lengths, st.integers(0, 9))
def test_what_one_gains_the_other_loses(lengths, seed):
    a, b = squares(lengths, seed), squares(lengths, seed + 100)
    for there, back in zip(block_gains(a, b, 0.1), block_gains(b, a, 0.1), strict=True):
        np.testing.assert_allclose(there, -back, atol=1e-12)


@given(lengths, st.integers(0, 9), st.floats(0.1, 10))
def test_the_unit_of_the_error_does_not_matter(lengths, seed, unit):
    a, b = squares(lengths, seed), squares(lengths, seed + 100)
    scaled = block_gains([unit * x for x in a], [unit * x for x in b], unit * 0.1)
    for one, other in zip(block_gains(a, b, 0.1), scaled, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)


@given(lengths, st.integers(0, 9), st.floats(0.1, 0.9))
def test_a_constant_factor_is_its_logarithm(lengths, seed, factor):
    a = squares(lengths, seed)
    for gains in block_gains(a, [factor * x for x in a], 0.0):
        np.testing.assert_allclose(gains, -np.log(factor), rtol=1e-9)


def test_windows_in_which_nothing_happens_do_not_decide():
    a = np.tile([100.0, 1e-3], 40)  # every second window has nearly no error
    b = np.tile([50.0, 4e-3], 40)  # half of what matters is gone; what does not matter is worse
    (gains,) = block_gains([a], [b], 0.0)
    np.testing.assert_allclose(gains, np.log(2), rtol=1e-3)
    assert np.mean(np.log(a) - np.log(b)) < 0  # the mean of windows would say the reverse


@pytest.mark.parametrize(("windows", "blocks"), [(1, 1), (3, 1), (10, 5), (40, 20), (999, 20)])
def test_every_record_has_the_same_blocks_at_most(windows, blocks):
    assert count_blocks(windows) == blocks <= MAX_BLOCKS_PER_RECORD


@given(st.integers(1, 500))
def test_one_window_of_three_is_kept_and_never_fewer_than_blocks_need(count):
    errors = np.random.default_rng(count).normal(size=(count, 2, 1))
    part = SimpleNamespace(r=errors[..., 0])
    (even,), (loud,) = picks([part], is_loud=False), picks([part])
    for at in (even, loud):
        assert np.all(np.diff(at) > 0)
        assert at[0] >= 0
        assert at[-1] < count
        assert len(at) >= min(count, MIN_WINDOWS)
    assert len(loud) == len(even)
    if count >= THIN * MIN_WINDOWS:
        assert np.all(np.diff(even) == THIN)


def test_what_acts_in_one_window_is_among_those_that_are_fitted_first():
    """A stop that is hit once: windows that are spread evenly miss it in two of three logs."""
    missed = 0
    for hit in range(60):
        errors = np.full((60, 4), 1e-3)
        errors[hit] = 1.0
        part = SimpleNamespace(r=errors)
        assert hit in picks([part])[0]
        missed += hit not in picks([part], is_loud=False)[0]
    assert missed == 40
